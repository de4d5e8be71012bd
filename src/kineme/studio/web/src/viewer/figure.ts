/** A skeleton on the stage: tapered bones, round joints, a head, and their shadow. */
import * as THREE from "three";
import type { MotionHead } from "../messages";
import { TAPER, type Anatomy } from "./anatomy";

export interface Colors {
  body: string;
  joint: string;
  shadow: string;
}

const UP = new THREE.Vector3(0, 1, 0);
const LIGHT = new THREE.Vector3(0.35, 1, 0.25); // where the shadow's light comes from
const HEAD_WIDTH = 0.4; // of the length of the head's bone
const bone = new THREE.CylinderGeometry(TAPER, 1, 1, 10, 1, true).translate(0, 0.5, 0);
const ball = new THREE.SphereGeometry(1, 14, 10);

export class Figure {
  readonly group = new THREE.Group();
  private readonly bones: THREE.InstancedMesh;
  private readonly joints: THREE.InstancedMesh;
  private readonly skull: THREE.Mesh;
  private readonly shade = new THREE.Group();
  private readonly bodyPaint = new THREE.MeshLambertMaterial();
  private readonly jointPaint = new THREE.MeshLambertMaterial();
  private readonly shadowPaint = new THREE.MeshBasicMaterial();
  private readonly skullShadow: THREE.Mesh;

  constructor(
    private readonly head: MotionHead,
    private readonly anatomy: Anatomy,
  ) {
    this.bones = instanced(bone, this.bodyPaint, head.bones.length);
    this.joints = instanced(ball, this.jointPaint, head.joints.length);
    this.skull = new THREE.Mesh(ball, this.bodyPaint);
    this.skullShadow = new THREE.Mesh(ball, this.shadowPaint);
    this.skullShadow.matrixAutoUpdate = false;
    this.shade.matrixAutoUpdate = false;
    this.shade.matrix.copy(flattening(anatomy.ground + 0.001 * anatomy.size));
    this.shade.add(this.shadowOf(this.bones), this.shadowOf(this.joints), this.skullShadow);
    this.group.add(this.bones, this.joints, this.skull, this.shade);
  }

  /** Puts every joint where the pose has it (x, y, z per joint); NaN hides it and its bones. */
  pose(positions: Float32Array): void {
    const { bones, joints, skull } = this.anatomy;
    this.head.bones.forEach(([from, to], i) => {
      const radius = i === skull ? 0.6 * bones[i]! : bones[i]!;
      this.bones.setMatrixAt(i, between(at(positions, from, a), at(positions, to, b), radius));
    });
    for (let i = 0; i < joints.length; i++) {
      at(positions, i, a);
      const radius = Number.isNaN(a.x) ? 0 : joints[i]!;
      this.joints.setMatrixAt(i, matrix.makeScale(radius, radius, radius).setPosition(known(a)));
    }
    this.placeSkull(positions);
    this.bones.instanceMatrix.needsUpdate = true;
    this.joints.instanceMatrix.needsUpdate = true;
  }

  paint(colors: Colors): void {
    this.bodyPaint.color.set(colors.body);
    this.jointPaint.color.set(colors.joint);
    this.shadowPaint.color.set(colors.shadow);
  }

  dispose(): void {
    this.bones.dispose();
    this.joints.dispose();
    for (const paint of [this.bodyPaint, this.jointPaint, this.shadowPaint]) paint.dispose();
  }

  private placeSkull(positions: Float32Array): void {
    const pair = this.head.bones[this.anatomy.skull];
    this.skull.visible = this.skullShadow.visible = pair !== undefined;
    if (!pair) return;
    at(positions, pair[0], a);
    at(positions, pair[1], b);
    const length = a.distanceTo(b);
    this.skull.visible = this.skullShadow.visible = length > 0;
    if (!(length > 0)) return;
    const width = Math.min(HEAD_WIDTH * length, 0.07 * this.anatomy.size);
    this.skull.quaternion.setFromUnitVectors(UP, b.clone().sub(a).divideScalar(length));
    this.skull.position.copy(a).lerp(b, 0.55);
    this.skull.scale.set(width, 0.55 * length, width * 1.1);
    this.skull.updateMatrix();
    this.skullShadow.matrix.copy(this.skull.matrix);
  }

  private shadowOf(mesh: THREE.InstancedMesh): THREE.InstancedMesh {
    const shadow = instanced(mesh.geometry, this.shadowPaint, mesh.count);
    shadow.instanceMatrix = mesh.instanceMatrix; // one buffer for both
    return shadow;
  }
}

const a = new THREE.Vector3();
const b = new THREE.Vector3();
const direction = new THREE.Vector3();
const size = new THREE.Vector3();
const turn = new THREE.Quaternion();
const matrix = new THREE.Matrix4();

function instanced(
  geometry: THREE.BufferGeometry,
  paint: THREE.Material,
  n: number,
): THREE.InstancedMesh {
  const mesh = new THREE.InstancedMesh(geometry, paint, n);
  mesh.frustumCulled = false; // its bounds change with every pose
  return mesh;
}

function at(positions: Float32Array, joint: number, out: THREE.Vector3): THREE.Vector3 {
  return out.fromArray(positions, 3 * joint);
}

function known(point: THREE.Vector3): THREE.Vector3 {
  return Number.isNaN(point.x) ? point.set(0, 0, 0) : point;
}

/** Brings the unit bone between two points; to nothing where a point is missing. */
function between(from: THREE.Vector3, to: THREE.Vector3, radius: number): THREE.Matrix4 {
  const length = direction.subVectors(to, from).length();
  if (!(length > 0)) return matrix.makeScale(0, 0, 0);
  turn.setFromUnitVectors(UP, direction.divideScalar(length));
  return matrix.compose(from, turn, size.set(radius, length, radius));
}

/** Projects along the light onto the plane at a height. */
function flattening(height: number): THREE.Matrix4 {
  const x = LIGHT.x / LIGHT.y;
  const z = LIGHT.z / LIGHT.y;
  return new THREE.Matrix4(
    ...([1, -x, 0, x * height] as const),
    ...([0, 0, 0, height] as const),
    ...([0, -z, 1, z * height] as const),
    ...([0, 0, 0, 1] as const),
  );
}

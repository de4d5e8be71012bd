/** Draw figures: bones, joints, a head and a shadow; ghosts and trails of hands and feet. */
import * as THREE from "three";
import type { MotionHead, Segment } from "../messages";
import {
  TAPER,
  getAnatomy,
  getFigureTime,
  movePose,
  type Anatomy,
  type Placement,
} from "./placement";
import { createBodyMaterial, createTrailMaterial, type Fog } from "./stage";
import {
  computePose,
  createPose,
  findRoot,
  getHeading,
  getRootPosition,
  type Motion,
} from "../motion";
import { readColor } from "../drawing";

type Colors = Record<"body" | "joint" | "shadow", string>;

const UP = new THREE.Vector3(0, 1, 0);
const LIGHT = new THREE.Vector3(0.35, 1, 0.25); // direction of the light that casts the shadow
const HEAD_WIDTH = 0.4; // of the length of the head's bone
const bone = new THREE.CylinderGeometry(TAPER, 1, 1, 10, 1, true).translate(0, 0.5, 0);
const ball = new THREE.SphereGeometry(1, 14, 10);

export class Figure {
  readonly group = new THREE.Group();
  private readonly bones: THREE.InstancedMesh;
  private readonly joints: THREE.InstancedMesh;
  private readonly skull: THREE.InstancedMesh;
  private readonly meshes: readonly THREE.InstancedMesh[];
  private readonly materials: Record<keyof Colors, THREE.RawShaderMaterial>;

  constructor(
    haze: Fog,
    private readonly head: MotionHead,
    private readonly anatomy: Anatomy,
  ) {
    this.materials = {
      body: createBodyMaterial(haze, 1),
      joint: createBodyMaterial(haze, 1),
      shadow: createBodyMaterial(haze, 0),
    };
    const { body, joint } = this.materials;
    this.bones = createInstances(bone, body, head.bones.length);
    this.joints = createInstances(ball, joint, head.joints.length);
    this.skull = createInstances(ball, body, 1);
    this.meshes = [this.bones, this.joints, this.skull];
    const shade = new THREE.Group();
    shade.matrixAutoUpdate = false;
    shade.matrix.copy(createShadowMatrix(anatomy.ground + 0.001 * anatomy.size));
    shade.add(...this.meshes.map((mesh) => this.createShadow(mesh)));
    this.group.add(...this.meshes, shade);
  }

  /** Apply a pose (x, y, z per joint); NaN hides a joint and its bones. */
  setPose(positions: Float32Array): void {
    const { bones, joints, skull } = this.anatomy;
    this.head.bones.forEach(([from, to], i) => {
      const radius = i === skull ? 0.6 * bones[i]! : bones[i]!;
      const ends = [readPoint(positions, from, a), readPoint(positions, to, b)] as const;
      this.bones.setMatrixAt(i, placeBone(...ends, radius));
    });
    for (const [i, radius] of joints.entries()) {
      const isMissing = Number.isNaN(readPoint(positions, i, a).x);
      matrix.makeScale(radius, radius, radius).setPosition(a);
      this.joints.setMatrixAt(i, isMissing ? matrix.makeScale(0, 0, 0) : matrix);
    }
    this.skull.setMatrixAt(0, this.placeSkull(positions));
    for (const mesh of this.meshes) mesh.instanceMatrix.needsUpdate = true;
  }

  setColors(colors: Colors): void {
    for (const part of ["body", "joint", "shadow"] as const)
      (this.materials[part].uniforms.color!.value as THREE.Color).set(colors[part]);
  }

  /** Make the figure transparent, without a shadow. */
  setOpacity(alpha: number): void {
    for (const paint of [this.materials.body, this.materials.joint]) {
      paint.uniforms.alpha!.value = alpha;
      paint.transparent = true;
    }
    this.materials.shadow.visible = false;
  }

  dispose(): void {
    for (const mesh of this.meshes) mesh.dispose();
    for (const paint of Object.values(this.materials)) paint.dispose();
  }

  /** Return the matrix of the head; zero if there is none. */
  private placeSkull(positions: Float32Array): THREE.Matrix4 {
    const pair = this.head.bones[this.anatomy.skull];
    if (!pair) return matrix.makeScale(0, 0, 0);
    readPoint(positions, pair[0], a);
    readPoint(positions, pair[1], b);
    const length = direction.subVectors(b, a).length();
    if (!(length > 0)) return matrix.makeScale(0, 0, 0);
    const width = Math.min(HEAD_WIDTH * length, 0.07 * this.anatomy.size);
    turn.setFromUnitVectors(UP, direction.divideScalar(length));
    return matrix.compose(a.lerp(b, 0.55), turn, size.set(width, 0.55 * length, width * 1.1));
  }

  private createShadow(mesh: THREE.InstancedMesh): THREE.InstancedMesh {
    const shadow = createInstances(mesh.geometry, this.materials.shadow, mesh.count);
    shadow.instanceMatrix = mesh.instanceMatrix; // shares one buffer
    return shadow;
  }
}

const a = new THREE.Vector3();
const b = new THREE.Vector3();
const direction = new THREE.Vector3();
const size = new THREE.Vector3();
const turn = new THREE.Quaternion();
const matrix = new THREE.Matrix4();

function createInstances(
  geometry: THREE.BufferGeometry,
  paint: THREE.Material,
  n: number,
): THREE.InstancedMesh {
  const mesh = new THREE.InstancedMesh(geometry, paint, n);
  mesh.frustumCulled = false; // its bounds change with every pose
  return mesh;
}

function readPoint(positions: Float32Array, joint: number, out: THREE.Vector3): THREE.Vector3 {
  return out.fromArray(positions, 3 * joint);
}

/** Return the matrix that moves the unit bone between two points; zero if one is missing. */
function placeBone(from: THREE.Vector3, to: THREE.Vector3, radius: number): THREE.Matrix4 {
  const length = direction.subVectors(to, from).length();
  if (!(length > 0)) return matrix.makeScale(0, 0, 0);
  turn.setFromUnitVectors(UP, direction.divideScalar(length));
  return matrix.compose(from, turn, size.set(radius, length, radius));
}

/** Return the projection along the light onto a horizontal plane. */
function createShadowMatrix(height: number): THREE.Matrix4 {
  const x = LIGHT.x / LIGHT.y;
  const z = LIGHT.z / LIGHT.y;
  return new THREE.Matrix4(
    ...([1, -x, 0, x * height] as const),
    ...([0, 0, 0, height] as const),
    ...([0, -z, 1, z * height] as const),
    ...([0, 0, 0, 1] as const),
  );
}

const OPACITY = 0.5;

/** Draw a repetition over the current one, with the same start and in step with it. */
export class Ghost {
  private figure: Figure | null = null;
  private motion: Motion | null = null;
  private pose = new Float32Array(0);

  constructor(
    private readonly scene: THREE.Scene,
    private readonly haze: Fog,
  ) {}

  /** Show a segment over another one at a time (seconds); null hides it. */
  show(motion: Motion, segment: Segment | null, over: Segment | undefined, seconds: number): void {
    if (!segment || !over || over.start_frame === segment.start_frame) {
      if (this.figure) this.figure.group.visible = false;
      return;
    }
    const figure = this.getFigure(motion);
    const placement = computeGhostPlacement(motion, segment, over);
    const time = getFigureTime({ motion, name: "", placement, segment }, seconds, over);
    computePose(motion, time, this.pose);
    movePose(this.pose, placement, findRoot(motion.head));
    figure.setPose(this.pose);
    const color = readColor("accent");
    figure.setColors({ body: color, joint: color, shadow: color });
    figure.group.visible = true;
  }

  clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
    this.figure = this.motion = null;
  }

  private getFigure(motion: Motion): Figure {
    if (this.figure && this.motion === motion) return this.figure;
    this.clear();
    const figure = new Figure(this.haze, motion.head, getAnatomy(motion));
    figure.setOpacity(OPACITY);
    this.scene.add(figure.group);
    this.pose = createPose(motion);
    [this.figure, this.motion] = [figure, motion];
    return figure;
  }
}

/** Return the placement that gives a repetition the start and heading of another. */
function computeGhostPlacement(motion: Motion, segment: Segment, over: Segment): Placement {
  const [slot, from] = [over, segment].map((each) => getRootPosition(motion, each.start_s));
  const turn = getHeading(motion, over.start_s) - getHeading(motion, segment.start_s);
  return { slot: slot!, from: from!, turn, isFixed: false };
}

/** Points per trail. */
const POINTS = 32;

export class Trails {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material>;
  private readonly positions: THREE.BufferAttribute;
  private readonly colors: THREE.BufferAttribute;

  constructor(
    haze: Fog,
    private readonly n_trails: number,
    private readonly width: number,
  ) {
    const vertices = n_trails * POINTS * 2;
    this.positions = new THREE.BufferAttribute(new Float32Array(vertices * 3), 3);
    this.colors = new THREE.BufferAttribute(new Float32Array(vertices * 4), 4);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", this.colors);
    geometry.setIndex(createIndex(n_trails));
    this.mesh = new THREE.Mesh(geometry, createTrailMaterial(haze));
    this.mesh.frustumCulled = false;
  }

  /** Return the times of a trail's points, oldest first, over the last `length` seconds. */
  static listTimes(now: number, length: number): number[] {
    return Array.from({ length: POINTS }, (_, i) => now - length * (1 - i / (POINTS - 1)));
  }

  /** Draw trails; `paths[trail]` holds x, y, z at each time, `colors[trail]` the colours. */
  draw(
    paths: readonly Float32Array[],
    colors: readonly (readonly THREE.Color[])[],
    camera: THREE.Vector3,
  ): void {
    for (let trail = 0; trail < this.n_trails; trail++) {
      const path = paths[trail]!;
      for (let i = 0; i < POINTS; i++) {
        const side = this.computeSide(path, i, camera);
        const vertex = 2 * (trail * POINTS + i);
        here.fromArray(path, 3 * i);
        const missing = Number.isNaN(here.x);
        if (missing) here.set(0, 0, 0);
        const alpha = missing ? 0 : 0.85 * (i / (POINTS - 1)) ** 1.5;
        const { r, g, b } = colors[trail]![i]!;
        for (const [k, sign] of [-1, 1].entries()) {
          const { x, y, z } = here;
          this.positions.setXYZ(
            vertex + k,
            x + sign * side.x,
            y + sign * side.y,
            z + sign * side.z,
          );
          this.colors.setXYZW(vertex + k, r, g, b, alpha);
        }
      }
    }
    this.positions.needsUpdate = true;
    this.colors.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  /** Return half of the ribbon's width as a vector, so that it faces the camera. */
  private computeSide(path: Float32Array, i: number, camera: THREE.Vector3): THREE.Vector3 {
    const before = Math.max(i - 1, 0);
    const after = Math.min(i + 1, POINTS - 1);
    along.fromArray(path, 3 * after).sub(other.fromArray(path, 3 * before));
    sight.fromArray(path, 3 * i).sub(camera);
    across.crossVectors(along, sight);
    const length = across.length();
    const half = (this.width / 2) * (0.3 + (0.7 * i) / POINTS);
    return length > 1e-9 ? across.multiplyScalar(half / length) : across.set(0, 0, 0);
  }
}

const here = new THREE.Vector3();
const along = new THREE.Vector3();
const other = new THREE.Vector3();
const sight = new THREE.Vector3();
const across = new THREE.Vector3();

function createIndex(n_trails: number): number[] {
  const index: number[] = [];
  for (let trail = 0; trail < n_trails; trail++) {
    for (let i = 0; i < POINTS - 1; i++) {
      const v = 2 * (trail * POINTS + i);
      index.push(v, v + 1, v + 2, v + 1, v + 3, v + 2);
    }
  }
  return index;
}

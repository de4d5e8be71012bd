/** Draw the recent paths of hands and feet as fading ribbons in cluster colours. */
import * as THREE from "three";
import { type Fog, createTrailMaterial } from "./materials";

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
    direction.fromArray(path, 3 * after).sub(other.fromArray(path, 3 * before));
    sight.fromArray(path, 3 * i).sub(camera);
    across.crossVectors(direction, sight);
    const length = across.length();
    const half = (this.width / 2) * (0.3 + (0.7 * i) / POINTS);
    return length > 1e-9 ? across.multiplyScalar(half / length) : across.set(0, 0, 0);
  }
}

const here = new THREE.Vector3();
const direction = new THREE.Vector3();
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

/** Draw the ground: a plane with a grid that fades into the sky. */
import * as THREE from "three";
import { readColor } from "../theme";
import { createFloorMaterial, type Fog } from "./materials";

const REACH = 40; // cells to each side

export class Floor {
  /** Sky colour and the distances between which objects fade into it. */
  readonly fog: Fog = { sky: { value: new THREE.Color() }, fade: { value: new THREE.Vector2() } };
  readonly mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.Material>;
  private readonly uniforms = {
    ...this.fog,
    ground: { value: new THREE.Color() },
    grid: { value: new THREE.Color() },
    cell: { value: 1 },
  };

  constructor() {
    const plane = new THREE.PlaneGeometry(1, 1).rotateX(-Math.PI / 2);
    this.mesh = new THREE.Mesh(plane, createFloorMaterial(this.uniforms));
    this.mesh.renderOrder = -1; // drawn first, below everything else
    this.mesh.frustumCulled = false;
  }

  setColors(): void {
    for (const name of ["ground", "grid", "sky"] as const)
      this.uniforms[name].value.set(readColor(name));
  }

  /** Set the grid's height and choose a cell size for a body's size. */
  fit(size: number, height: number): void {
    this.uniforms.cell.value = 10 ** Math.round(Math.log10(size / 1.7));
    this.mesh.scale.setScalar(2 * REACH * this.uniforms.cell.value);
    this.mesh.position.y = height;
  }

  /** Centre the floor below a point `away` metres from the camera. */
  centerOn(target: THREE.Vector3, away: number): void {
    this.mesh.position.x = target.x;
    this.mesh.position.z = target.z;
    const far = Math.min(away * 6, away + 0.8 * REACH * this.uniforms.cell.value);
    this.uniforms.fade.value.set(away * 1.1, far);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

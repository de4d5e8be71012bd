/** The ground: a plane with a grid on it that fades into the sky. */
import * as THREE from "three";
import { floorPaint, type Haze } from "./paints";

const REACH = 40; // cells to each side

export interface RoomColors {
  sky: string;
  ground: string;
  grid: string;
}

export class Floor {
  /** The sky, and from where to where things fade into it. */
  readonly haze: Haze = { sky: { value: new THREE.Color() }, fade: { value: new THREE.Vector2() } };
  readonly mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.Material>;
  private readonly look = {
    ...this.haze,
    ground: { value: new THREE.Color() },
    grid: { value: new THREE.Color() },
    cell: { value: 1 },
  };

  constructor() {
    const plane = new THREE.PlaneGeometry(1, 1).rotateX(-Math.PI / 2);
    this.mesh = new THREE.Mesh(plane, floorPaint(this.look));
    this.mesh.renderOrder = -1; // below everything else, so it is drawn first
    this.mesh.frustumCulled = false;
  }

  paint(colors: RoomColors): void {
    this.look.ground.value.set(colors.ground);
    this.look.grid.value.set(colors.grid);
    this.look.sky.value.set(colors.sky);
  }

  /** A grid of cells that suit a body's size, at a height. */
  fit(size: number, height: number): void {
    this.look.cell.value = 10 ** Math.round(Math.log10(size / 1.7));
    this.mesh.scale.setScalar(2 * REACH * this.look.cell.value);
    this.mesh.position.y = height;
  }

  /** Lies around a point that is so far from the camera. */
  lieAround(target: THREE.Vector3, away: number): void {
    this.mesh.position.x = target.x;
    this.mesh.position.z = target.z;
    const far = Math.min(away * 6, away + 0.8 * REACH * this.look.cell.value);
    this.look.fade.value.set(away * 1.1, far);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

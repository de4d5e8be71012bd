/** The room: light, ground and camera, and one picture of it when asked. */
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Floor, type RoomColors } from "./floor";
import { drawsInSoftware, Sharpness } from "./sharpness";

const FIELD = 32; // degrees from the lower to the upper edge

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(FIELD, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  private readonly sharpness: Sharpness;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly floor = new Floor();
  private readonly fog = new THREE.Fog(0, 1, 10);

  constructor(canvas: HTMLCanvasElement) {
    const software = drawsInSoftware();
    this.sharpness = new Sharpness(software);
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: !software, // a picture that stands still is drawn larger instead
      powerPreference: "low-power",
    });
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false; // the picture stands still as soon as the hand does
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.scene.fog = this.fog;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f99, 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.7);
    sun.position.set(2, 5, 3);
    this.scene.add(sun);
    this.scene.add(this.floor.mesh);
  }

  /** Scales ground, fog and limits of the camera to a body's size. */
  fit(size: number, ground: number): void {
    this.floor.fit(size, ground);
    this.controls.minDistance = 0.5 * size;
    this.controls.maxDistance = 14 * size;
    this.camera.near = 0.05 * size;
    this.camera.far = 120 * size;
    this.camera.updateProjectionMatrix();
  }

  paint(colors: RoomColors): void {
    this.scene.background = new THREE.Color(colors.sky);
    this.fog.color.set(colors.sky);
    this.floor.paint(colors);
  }

  /** Looks at a point from a side (radians about y), so that a box of some size fills the view. */
  look(target: THREE.Vector3, side: number, width: number, height: number, lift = 0.22): void {
    const half = Math.tan((FIELD * Math.PI) / 360);
    const away = Math.max(height / 2 / half, width / 2 / (half * this.camera.aspect)) * 1.12;
    this.controls.target.copy(target);
    this.camera.position.set(
      target.x + away * Math.sin(side),
      target.y + away * lift,
      target.z + away * Math.cos(side),
    );
    this.controls.update();
  }

  /** Moves the camera and what it looks at to another point on the ground. */
  moveTo(x: number, z: number): void {
    const dx = x - this.controls.target.x;
    const dz = z - this.controls.target.z;
    this.controls.target.x += dx;
    this.controls.target.z += dz;
    this.camera.position.x += dx;
    this.camera.position.z += dz;
    this.controls.update();
  }

  /** Goes round what the camera looks at, and up or down (radians). */
  turn(round: number, down: number): void {
    const { target, minPolarAngle, maxPolarAngle } = this.controls;
    const arm = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(target));
    arm.theta += round;
    arm.phi = Math.min(Math.max(arm.phi + down, minPolarAngle + 0.01), maxPolarAngle);
    this.camera.position.setFromSpherical(arm).add(target);
    this.controls.update();
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
  }

  /** Draws; a moving picture with as many pixels as there is time for. */
  draw(moving: boolean, seconds: number): void {
    if (moving) this.sharpness.learn(seconds);
    const ratio = this.sharpness.ratio(devicePixelRatio, moving);
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    const { target } = this.controls;
    const fade = this.floor.lieAround(target, this.camera.position.distanceTo(target));
    [this.fog.near, this.fog.far] = [fade.x, fade.y];
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.controls.dispose();
    this.floor.dispose();
    this.renderer.dispose();
  }
}

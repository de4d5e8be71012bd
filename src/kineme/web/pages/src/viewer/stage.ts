/** The room: ground, haze and camera, and one picture of it when asked. */
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Floor, type RoomColors } from "./floor";
import { bodyPaint, type Haze } from "./paints";
import { Sharpness } from "./sharpness";

const FIELD = 32; // degrees from the lower to the upper edge

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(FIELD, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  private readonly sharpness: Sharpness;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly floor = new Floor();
  private readonly prepared: THREE.InstancedMesh<THREE.BufferGeometry, THREE.Material>;

  constructor(canvas: HTMLCanvasElement) {
    const { context, software } = contextOf(canvas);
    this.sharpness = new Sharpness(software);
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.debug.checkShaderErrors = false; // to ask is to wait
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false; // the picture stands still as soon as the hand does
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.scene.add(this.floor.mesh);
    // What the first picture needs is made ready while the recording is on its way, and stays so.
    this.prepared = new THREE.InstancedMesh(new THREE.BufferGeometry(), bodyPaint(this.haze, 1), 1);
    for (const each of [this.floor.mesh, this.prepared]) this.renderer.compile(each, this.camera);
  }

  /** What things on the stage fade into. */
  get haze(): Haze {
    return this.floor.haze;
  }

  /** Scales ground and limits of the camera to a body's size. */
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
    this.floor.lieAround(target, this.camera.position.distanceTo(target));
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.controls.dispose();
    this.floor.dispose();
    this.prepared.material.dispose();
    this.renderer.dispose();
  }
}

/**
 * Something to draw with, and whether that is the processor, for want of a graphics card.
 *
 * Edges are smooth because pictures are drawn larger than they are shown.
 */
function contextOf(canvas: HTMLCanvasElement): {
  context: WebGL2RenderingContext;
  software: boolean;
} {
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight]; // to grow later costs
  const wishes = { alpha: false, antialias: false, powerPreference: "low-power" };
  const context = canvas.getContext("webgl2", wishes) as WebGL2RenderingContext | null;
  if (!context) throw new Error("This browser draws no pictures in 3-D (it has no WebGL 2).");
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  return { context, software: /swiftshader|llvmpipe|software|basic render/i.test(name) };
}

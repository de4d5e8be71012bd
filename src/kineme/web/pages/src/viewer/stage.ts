/** Hold ground, fog, camera and renderer. */
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { readColor } from "../theme";
import { createBodyMaterial, type Fog, createFloorMaterial } from "./materials";

const FIELD_OF_VIEW = 32; // vertical, degrees

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 1000);
  readonly controls: OrbitControls;
  private readonly sharpness: Sharpness;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly floor = new Floor();
  private readonly warmUpMesh: THREE.InstancedMesh<THREE.BufferGeometry, THREE.Material>;

  constructor(canvas: HTMLCanvasElement) {
    const { context, software } = createContext(canvas);
    this.sharpness = new Sharpness(software);
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.debug.checkShaderErrors = false; // querying errors blocks
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false; // the view stops with the pointer
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.scene.add(this.floor.mesh);
    // Compile shaders while the recording loads.
    this.warmUpMesh = new THREE.InstancedMesh(
      new THREE.BufferGeometry(),
      createBodyMaterial(this.fog, 1),
      1,
    );
    for (const each of [this.floor.mesh, this.warmUpMesh]) this.renderer.compile(each, this.camera);
  }

  get fog(): Fog {
    return this.floor.fog;
  }

  /** Scale ground and camera limits to a body's size (metres). */
  fit(size: number, ground: number): void {
    this.floor.fit(size, ground);
    this.controls.minDistance = 0.5 * size;
    this.controls.maxDistance = 14 * size;
    this.camera.near = 0.05 * size;
    this.camera.far = 120 * size;
    this.camera.updateProjectionMatrix();
  }

  /** Apply the colours of the theme. */
  setColors(): void {
    this.scene.background = new THREE.Color(readColor("sky"));
    this.floor.setColors();
  }

  /** Look at a point from a side (radians about y) so that a box fills the view. */
  lookAt(target: THREE.Vector3, side: number, width: number, height: number, lift = 0.22): void {
    const half = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const away = Math.max(height / 2 / half, width / 2 / (half * this.camera.aspect)) * 1.12;
    this.controls.target.copy(target);
    this.camera.position.set(
      target.x + away * Math.sin(side),
      target.y + away * lift,
      target.z + away * Math.cos(side),
    );
    this.controls.update();
  }

  /** Move camera and target to another point on the ground. */
  moveTo(x: number, z: number): void {
    const dx = x - this.controls.target.x;
    const dz = z - this.controls.target.z;
    this.controls.target.x += dx;
    this.controls.target.z += dz;
    this.camera.position.x += dx;
    this.camera.position.z += dz;
    this.controls.update();
  }

  /** Turn the camera around its target (radians). */
  orbit(round: number, down: number): void {
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

  /** Draw a frame; during motion the resolution adapts to the drawing time. */
  draw(moving: boolean, seconds: number): void {
    if (moving) this.sharpness.recordDuration(seconds);
    const ratio = this.sharpness.getRatio(devicePixelRatio, moving);
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    const { target } = this.controls;
    this.floor.centerOn(target, this.camera.position.distanceTo(target));
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.controls.dispose();
    this.floor.dispose();
    this.warmUpMesh.material.dispose();
    this.renderer.dispose();
  }
}

/** Return a WebGL context, and whether it renders in software. */
function createContext(canvas: HTMLCanvasElement): {
  context: WebGL2RenderingContext;
  software: boolean;
} {
  // Resizing later is slow.
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
  const wishes = { alpha: false, antialias: false, powerPreference: "low-power" };
  const context = canvas.getContext("webgl2", wishes) as WebGL2RenderingContext | null;
  if (!context) throw new Error("This browser draws no pictures in 3-D (it has no WebGL 2).");
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  return { context, software: /swiftshader|llvmpipe|software|basic render/i.test(name) };
}

const REACH = 40; // cells to each side

/** Draw the ground: a plane with a grid that fades into the sky. */
class Floor {
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

const MIN_FRAME_RATE = 36; // frames per second; a higher rate is not worth blurred edges
const MIN_SHARE = 0.5;
const SUPERSAMPLING = 2;
const ADJUST_INTERVAL = 24; // frames between two changes

/** Pixels per CSS pixel, adapted to the duration of frames. */
class Sharpness {
  /** Share of the full ratio during playback. */
  private share = 1;
  private slow = 0;
  private drawn = 0;

  constructor(private readonly software: boolean) {}

  /** Return the pixel ratio for a moving or a static picture. */
  getRatio(screen: number, moving: boolean): number {
    if (!moving) return this.software ? Math.max(screen, 1.5) : SUPERSAMPLING;
    return this.share * (this.software ? Math.min(screen, 1) : SUPERSAMPLING);
  }

  /** Record the seconds since the last moving frame and lower the resolution if most are slow. */
  recordDuration(seconds: number): void {
    this.drawn += 1;
    if (seconds > 1 / MIN_FRAME_RATE) this.slow += 1;
    if (this.drawn < ADJUST_INTERVAL) return;
    const late = this.slow / this.drawn > 0.5;
    this.drawn = this.slow = 0;
    if (late) this.share = Math.max(this.share * 0.8, MIN_SHARE);
  }
}

/** Hold ground, fog, camera and renderer, and the shaders of everything on the stage. */
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { readColor } from "../drawing";

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

  /** Turn the camera around its target by an azimuth and a polar angle, radians. */
  orbit(azimuth: number, polar: number): void {
    const { target, minPolarAngle, maxPolarAngle } = this.controls;
    const offset = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(target));
    offset.theta += azimuth;
    // Straight above the target, the direction of the camera's up axis would be undefined.
    const lowest = minPolarAngle + 0.01;
    offset.phi = Math.min(Math.max(offset.phi + polar, lowest), maxPolarAngle);
    this.camera.position.setFromSpherical(offset).add(target);
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
    const material = createMaterial(FLOOR_VERTEX, FLOOR_FRAGMENT, this.uniforms);
    material.setValues({ depthTest: false, depthWrite: false });
    this.mesh = new THREE.Mesh(plane, material);
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

/** Sky colour and fading distances, shared by all materials. */
export interface Fog {
  sky: { value: THREE.Color };
  fade: { value: THREE.Vector2 };
}

const FRAGMENT_HEAD = `
precision highp float;
uniform vec3 sky;
uniform vec2 fade;
out vec4 pixel;
vec4 onScreen(vec3 light, float alpha) {
  vec3 bright = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return vec4(mix(bright, 12.92 * light, vec3(lessThanEqual(light, vec3(0.0031308)))), alpha);
}
`;

const VERTEX_HEAD = `
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
`;

// Light comes from above and from a sun; low parts get reflected light.
const BODY_VERTEX = `${VERTEX_HEAD}
in mat4 instanceMatrix;
in vec3 normal;
uniform vec3 color;
uniform float lit;
uniform float alpha;
out vec4 paint;
out float far;
const vec3 SUN = normalize(vec3(2.0, 5.0, 3.0));
const vec3 GROUND = vec3(0.254, 0.275, 0.318);
void main() {
  mat3 turn = mat3(instanceMatrix);
  vec3 size = vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
  vec3 up = normalize(turn * (normal / max(size, 1e-12)) + vec3(0.0, 1e-9, 0.0));
  vec3 light = 0.67 * mix(GROUND, vec3(1.0), 0.5 + 0.5 * up.y) + 0.54 * max(dot(up, SUN), 0.0);
  paint = vec4(color * mix(vec3(1.0), light, lit), alpha);
  vec4 place = viewMatrix * modelMatrix * instanceMatrix * vec4(position, 1.0);
  far = -place.z;
  gl_Position = projectionMatrix * place;
}`;
const TRAIL_VERTEX = `${VERTEX_HEAD}
in vec4 color;
out vec4 paint;
out float far;
void main() {
  vec4 place = viewMatrix * modelMatrix * vec4(position, 1.0);
  paint = color;
  far = -place.z;
  gl_Position = projectionMatrix * place;
}`;

// Colours fade into the sky with distance.
const FOG_FRAGMENT = `${FRAGMENT_HEAD}
in vec4 paint;
in float far;
void main() {
  pixel = onScreen(mix(paint.rgb, sky, smoothstep(fade.x, fade.y, far)), paint.a);
}`;

// Lines are computed per pixel, about one pixel wide, and vanish where they would be too dense.
const FLOOR_VERTEX = `${VERTEX_HEAD}
out vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const FLOOR_FRAGMENT = `${FRAGMENT_HEAD}
uniform vec3 cameraPosition;
uniform vec3 ground;
uniform vec3 grid;
uniform float cell;
in vec3 place;
void main() {
  vec2 at = place.xz / cell;
  vec2 wide = fwidth(at);
  vec2 away = abs(fract(at - 0.5) - 0.5);
  vec2 line = (1.0 - smoothstep(0.5 * wide, 1.5 * wide, away)) * (1.0 - min(2.0 * wide, 1.0));
  float far = smoothstep(fade.x, fade.y, distance(place, cameraPosition));
  pixel = onScreen(mix(mix(ground, grid, max(line.x, line.y)), sky, far), 1.0);
}`;

/** Create a material for instances of one colour; `lit` is 1 for bodies and 0 for shadows. */
export function createBodyMaterial(haze: Fog, lit: 0 | 1): THREE.RawShaderMaterial {
  const colors = { color: { value: new THREE.Color() }, lit: { value: lit }, alpha: { value: 1 } };
  return createMaterial(BODY_VERTEX, FOG_FRAGMENT, { ...haze, ...colors });
}

/** Create a material for ribbons with transparent vertex colours. */
export function createTrailMaterial(haze: Fog): THREE.RawShaderMaterial {
  const made = createMaterial(TRAIL_VERTEX, FOG_FRAGMENT, { ...haze });
  made.setValues({ transparent: true, depthWrite: false, side: THREE.DoubleSide });
  return made;
}

function createMaterial(
  vertexShader: string,
  fragmentShader: string,
  uniforms: Record<string, THREE.IUniform>,
): THREE.RawShaderMaterial {
  const glslVersion = THREE.GLSL3;
  return new THREE.RawShaderMaterial({ glslVersion, vertexShader, fragmentShader, uniforms });
}

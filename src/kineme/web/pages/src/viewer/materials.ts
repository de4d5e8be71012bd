/** Define small shaders, as three.js' own take most of a second to compile in software. */
import * as THREE from "three";

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
  const uniforms = { ...haze, ...colors };
  return createMaterial(BODY_VERTEX, FOG_FRAGMENT, uniforms);
}

/** Create a material for ribbons with transparent vertex colours. */
export function createTrailMaterial(haze: Fog): THREE.RawShaderMaterial {
  const made = createMaterial(TRAIL_VERTEX, FOG_FRAGMENT, { ...haze });
  made.setValues({ transparent: true, depthWrite: false, side: THREE.DoubleSide });
  return made;
}

/** Create a material for the ground and its grid; it is drawn below everything else. */
export function createFloorMaterial(
  uniforms: Fog & Record<string, THREE.IUniform>,
): THREE.RawShaderMaterial {
  const made = createMaterial(FLOOR_VERTEX, FLOOR_FRAGMENT, uniforms);
  made.setValues({ depthTest: false, depthWrite: false });
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

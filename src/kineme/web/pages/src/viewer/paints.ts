/**
 * What things on the stage are painted with: three small shaders.
 *
 * Those that come with three.js can do far more, and take a processor that draws without a
 * graphics card most of a second to make ready. Colours are mixed as light is, in linear space.
 */
import * as THREE from "three";

/** How far away things begin to fade into the sky, and where they are gone; shared by all. */
export interface Haze {
  sky: { value: THREE.Color };
  fade: { value: THREE.Vector2 };
}

const HEAD = `
precision highp float;
uniform vec3 sky;
uniform vec2 fade;
out vec4 pixel;
vec4 onScreen(vec3 light, float alpha) {
  vec3 bright = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return vec4(mix(bright, 12.92 * light, vec3(lessThanEqual(light, vec3(0.0031308)))), alpha);
}
`;

const PLACED = `
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
`;

// Light falls from above, and from a sun; what stands low gets what the ground throws back.
const BODY_VERTEX = `${PLACED}
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
const TRAIL_VERTEX = `${PLACED}
in vec4 color;
out vec4 paint;
out float far;
void main() {
  vec4 place = viewMatrix * modelMatrix * vec4(position, 1.0);
  paint = color;
  far = -place.z;
  gl_Position = projectionMatrix * place;
}`;

// What is painted fades into the sky with its distance.
const HAZY_FRAGMENT = `${HEAD}
in vec4 paint;
in float far;
void main() {
  pixel = onScreen(mix(paint.rgb, sky, smoothstep(fade.x, fade.y, far)), paint.a);
}`;

// Lines are computed per pixel, about one pixel wide, and vanish where they would be denser.
const FLOOR_VERTEX = `${PLACED}
out vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const FLOOR_FRAGMENT = `${HEAD}
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

/** For instances of one colour; `lit` is 1 for bodies and 0 for shadows. */
export function bodyPaint(haze: Haze, lit: 0 | 1): THREE.RawShaderMaterial {
  const colors = { color: { value: new THREE.Color() }, lit: { value: lit }, alpha: { value: 1 } };
  const uniforms = { ...haze, ...colors };
  return paint(BODY_VERTEX, HAZY_FRAGMENT, uniforms);
}

/** For ribbons whose vertices have colours that one can see through. */
export function trailPaint(haze: Haze): THREE.RawShaderMaterial {
  const made = paint(TRAIL_VERTEX, HAZY_FRAGMENT, { ...haze });
  made.setValues({ transparent: true, depthWrite: false, side: THREE.DoubleSide });
  return made;
}

/** For the ground and the lines on it; everything else is drawn over it. */
export function floorPaint(
  uniforms: Haze & Record<string, THREE.IUniform>,
): THREE.RawShaderMaterial {
  const made = paint(FLOOR_VERTEX, FLOOR_FRAGMENT, uniforms);
  made.setValues({ depthTest: false, depthWrite: false });
  return made;
}

function paint(
  vertexShader: string,
  fragmentShader: string,
  uniforms: Record<string, THREE.IUniform>,
): THREE.RawShaderMaterial {
  const glslVersion = THREE.GLSL3;
  return new THREE.RawShaderMaterial({ glslVersion, vertexShader, fragmentShader, uniforms });
}

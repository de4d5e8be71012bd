/** The ground: a plane with a grid on it that fades into the sky. */
import * as THREE from "three";

const REACH = 40; // cells to each side

// Lines are computed per pixel, about one pixel wide, and vanish where they would be denser.
const VERTEX = `
varying vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const FRAGMENT = `
uniform vec3 ground;
uniform vec3 grid;
uniform vec3 sky;
uniform float cell;
uniform vec2 fade;
varying vec3 place;
void main() {
  vec2 at = place.xz / cell;
  vec2 pixel = fwidth(at);
  vec2 away = abs(fract(at - 0.5) - 0.5);
  vec2 line = (1.0 - smoothstep(0.5 * pixel, 1.5 * pixel, away)) * (1.0 - min(2.0 * pixel, 1.0));
  float far = smoothstep(fade.x, fade.y, distance(place, cameraPosition));
  gl_FragColor = vec4(mix(mix(ground, grid, max(line.x, line.y)), sky, far), 1.0);
  #include <colorspace_fragment>
}`;

export interface RoomColors {
  sky: string;
  ground: string;
  grid: string;
}

export class Floor {
  readonly mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
  private readonly look = {
    ground: { value: new THREE.Color() },
    grid: { value: new THREE.Color() },
    sky: { value: new THREE.Color() },
    cell: { value: 1 },
    fade: { value: new THREE.Vector2() },
  };

  constructor() {
    this.mesh = new THREE.Mesh(
      new THREE.PlaneGeometry(1, 1).rotateX(-Math.PI / 2),
      new THREE.ShaderMaterial({
        uniforms: this.look,
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        depthTest: false,
        depthWrite: false,
      }),
    );
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

  /** Lies around a point and fades between two distances from the camera, which it returns. */
  lieAround(target: THREE.Vector3, away: number): THREE.Vector2 {
    this.mesh.position.x = target.x;
    this.mesh.position.z = target.z;
    const far = Math.min(away * 6, away + 0.8 * REACH * this.look.cell.value);
    return this.look.fade.value.set(away * 1.1, far);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

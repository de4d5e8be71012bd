/** A loop on a stage of its own: one figure, which the camera goes along with. */
import * as THREE from "three";
import { headingAt, rootOf } from "../motion";
import { cssColor } from "../theme";
import { anatomyOfCached } from "./anatomy";
import { Figure } from "./figure";
import { loopPoseAt, type Loop } from "./loop";
import { Stage } from "./stage";

export class LoopScene {
  readonly stage: Stage;
  private loop: Loop | null = null;
  private figure: Figure | null = null;
  private pose = new Float32Array();

  constructor(canvas: HTMLCanvasElement, redraw: () => void) {
    this.stage = new Stage(canvas);
    this.stage.controls.addEventListener("change", redraw);
  }

  /** Another loop, seen from its side. */
  show(loop: Loop): void {
    this.clear();
    const { head } = loop.motion;
    const anatomy = anatomyOfCached(loop.motion);
    this.loop = loop;
    this.figure = new Figure(this.stage.haze, head, anatomy);
    this.pose = new Float32Array(3 * head.joints.length);
    this.stage.scene.add(this.figure.group);
    this.stage.fit(anatomy.size, anatomy.ground);
    loopPoseAt(loop, 0, this.pose);
    const [x, z] = this.rootPlace();
    const target = new THREE.Vector3(x, anatomy.ground + 0.5 * anatomy.size, z);
    const side = headingAt(loop.motion, 0) + 0.9;
    this.stage.look(target, side, 1.25 * anatomy.size, 1.3 * anatomy.size);
  }

  /** The picture so many seconds after the loop began. */
  draw(
    seconds: number,
    color: string,
    { moving, since }: { moving: boolean; since: number },
  ): void {
    if (!this.loop || !this.figure) return;
    this.stage.paint({ sky: cssColor("sky"), ground: cssColor("ground"), grid: cssColor("grid") });
    this.figure.paint({ body: cssColor("body"), joint: color, shadow: cssColor("shadow") });
    loopPoseAt(this.loop, seconds, this.pose);
    this.figure.pose(this.pose);
    this.stage.moveTo(...this.rootPlace());
    this.stage.draw(moving, since);
  }

  resize(width: number, height: number): void {
    this.stage.resize(width, height);
  }

  dispose(): void {
    this.clear();
    this.stage.dispose();
  }

  private rootPlace(): [number, number] {
    const root = 3 * rootOf(this.loop!.motion.head);
    return [this.pose[root] || 0, this.pose[root + 2] || 0];
  }

  private clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
  }
}

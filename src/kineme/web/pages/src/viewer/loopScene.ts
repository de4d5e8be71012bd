/** Draw a loop on its own stage; the camera follows the figure. */
import * as THREE from "three";
import { getHeading, findRoot } from "../motion";
import { readColor } from "../theme";
import { getAnatomy } from "./anatomy";
import { Figure } from "./figure";
import { computeLoopPose, type Loop } from "./loop";
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

  /** Show another loop, seen from its side. */
  show(loop: Loop): void {
    this.clear();
    const { head } = loop.motion;
    const anatomy = getAnatomy(loop.motion);
    this.loop = loop;
    this.figure = new Figure(this.stage.fog, head, anatomy);
    this.pose = new Float32Array(3 * head.joints.length);
    this.stage.scene.add(this.figure.group);
    this.stage.fit(anatomy.size, anatomy.ground);
    computeLoopPose(loop, 0, this.pose);
    const [x, z] = this.getRootPosition();
    const target = new THREE.Vector3(x, anatomy.ground + 0.5 * anatomy.size, z);
    const side = getHeading(loop.motion, 0) + 0.9;
    this.stage.lookAt(target, side, 1.25 * anatomy.size, 1.3 * anatomy.size);
  }

  /** Draw the loop at a time in seconds. */
  draw(
    seconds: number,
    color: string,
    { moving, since }: { moving: boolean; since: number },
  ): void {
    if (!this.loop || !this.figure) return;
    this.stage.setColors();
    this.figure.setColors({
      body: readColor("body"),
      joint: color,
      shadow: readColor("shadow"),
    });
    computeLoopPose(this.loop, seconds, this.pose);
    this.figure.setPose(this.pose);
    this.stage.moveTo(...this.getRootPosition());
    this.stage.draw(moving, since);
  }

  resize(width: number, height: number): void {
    this.stage.resize(width, height);
  }

  dispose(): void {
    this.clear();
    this.stage.dispose();
  }

  private getRootPosition(): [number, number] {
    const root = 3 * findRoot(this.loop!.motion.head);
    return [this.pose[root] || 0, this.pose[root + 2] || 0];
  }

  private clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
  }
}

/** Draw a repetition over the current one, with the same start and in step with it. */
import type * as THREE from "three";
import type { Segment } from "../messages";
import { getHeading, computePose, findRoot, type Motion } from "../motion";
import { readColor } from "../theme";
import { getAnatomy } from "./anatomy";
import { Figure } from "./figure";
import type { Fog } from "./materials";
import { movePose, getFigureTime, type Placement } from "./placement";

const OPACITY = 0.5;

export class Ghost {
  private figure: Figure | null = null;
  private motion: Motion | null = null;
  private pose = new Float32Array(0);

  constructor(
    private readonly scene: THREE.Scene,
    private readonly haze: Fog,
  ) {}

  /** Show a segment over another one at a time (seconds); null hides it. */
  show(motion: Motion, segment: Segment | null, over: Segment | undefined, seconds: number): void {
    if (!segment || !over || over.start_frame === segment.start_frame) {
      if (this.figure) this.figure.group.visible = false;
      return;
    }
    const figure = this.getFigure(motion);
    const placement = computeGhostPlacement(motion, segment, over);
    const time = getFigureTime({ motion, name: "", placement, segment }, seconds, over);
    computePose(motion, time, this.pose);
    movePose(this.pose, placement, findRoot(motion.head));
    figure.setPose(this.pose);
    const color = readColor("accent");
    figure.setColors({ body: color, joint: color, shadow: color });
    figure.group.visible = true;
  }

  clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
    this.figure = this.motion = null;
  }

  private getFigure(motion: Motion): Figure {
    if (this.figure && this.motion === motion) return this.figure;
    this.clear();
    const figure = new Figure(this.haze, motion.head, getAnatomy(motion));
    figure.setOpacity(OPACITY);
    this.scene.add(figure.group);
    this.pose = new Float32Array(motion.head.joints.length * 3);
    [this.figure, this.motion] = [figure, motion];
    return figure;
  }
}

/** Return the placement that gives a repetition the start and heading of another. */
export function computeGhostPlacement(motion: Motion, segment: Segment, over: Segment): Placement {
  const pose = new Float32Array(motion.head.joints.length * 3);
  const root = 3 * findRoot(motion.head);
  const at = (seconds: number): [number, number] => {
    computePose(motion, seconds, pose);
    return [pose[root] || 0, pose[root + 2] || 0];
  };
  const turn = getHeading(motion, over.start_s) - getHeading(motion, segment.start_s);
  return { slot: at(over.start_s), from: at(segment.start_s), turn, isFixed: false };
}

/** A repetition laid over the one that plays: it begins where that begins, and keeps step with it. */
import type * as THREE from "three";
import type { Segment } from "../messages";
import { headingAt, poseAt, rootOf, type Motion } from "../motion";
import { cssColor } from "../theme";
import { anatomyOfCached } from "./anatomy";
import { Figure } from "./figure";
import type { Haze } from "./paints";
import { putInPlace, timeOf, type Place } from "./placement";

const CLEARNESS = 0.5;

export class Ghost {
  private figure: Figure | null = null;
  private motion: Motion | null = null;
  private pose = new Float32Array(0);

  constructor(
    private readonly scene: THREE.Scene,
    private readonly haze: Haze,
  ) {}

  /** Shows a segment of a motion over another one, at a time of that; null: nothing. */
  show(motion: Motion, segment: Segment | null, over: Segment | undefined, seconds: number): void {
    if (!segment || !over || over.start_frame === segment.start_frame) {
      if (this.figure) this.figure.group.visible = false;
      return;
    }
    const figure = this.figureOf(motion);
    const place = placeOver(motion, segment, over);
    const time = timeOf({ motion, name: "", place, segment }, seconds, over);
    poseAt(motion, time, this.pose);
    putInPlace(this.pose, place, rootOf(motion.head));
    figure.pose(this.pose);
    const color = cssColor("accent");
    figure.paint({ body: color, joint: color, shadow: color });
    figure.group.visible = true;
  }

  clear(): void {
    this.figure?.group.removeFromParent();
    this.figure?.dispose();
    this.figure = this.motion = null;
  }

  private figureOf(motion: Motion): Figure {
    if (this.figure && this.motion === motion) return this.figure;
    this.clear();
    const figure = new Figure(this.haze, motion.head, anatomyOfCached(motion));
    figure.fade(CLEARNESS);
    this.scene.add(figure.group);
    this.pose = new Float32Array(motion.head.joints.length * 3);
    [this.figure, this.motion] = [figure, motion];
    return figure;
  }
}

/** Where a repetition goes, so that it begins where another one does, and faces the same way. */
export function placeOver(motion: Motion, segment: Segment, over: Segment): Place {
  const pose = new Float32Array(motion.head.joints.length * 3);
  const root = 3 * rootOf(motion.head);
  const at = (seconds: number): [number, number] => {
    poseAt(motion, seconds, pose);
    return [pose[root] || 0, pose[root + 2] || 0];
  };
  const turn = headingAt(motion, over.start_s) - headingAt(motion, segment.start_s);
  return { slot: at(over.start_s), from: at(segment.start_s), turn, still: false };
}

/** Keypoints over the picture of a video: where the picture lies in its box, and what is drawn. */
import type { Picture } from "../messages";
import { poseAt, type Motion } from "../motion";

/** Where a picture lies that is shown whole in the middle of a box, and pixels of the box in one. */
export interface Fitted {
  left: number;
  top: number;
  scale: number;
}

export function fitted(
  picture: Pick<Picture, "width" | "height">,
  width: number,
  height: number,
): Fitted {
  const scale = Math.min(width / picture.width, height / picture.height);
  const left = (width - scale * picture.width) / 2;
  return { left, top: (height - scale * picture.height) / 2, scale };
}

const SURE = 50; // of a hundred: keypoints below are drawn faintly
const FAINT = 0.35;

/** Draws the keypoints of the frame nearest to a time (seconds of the recording). */
export function drawKeypoints(
  pen: CanvasRenderingContext2D,
  { left, top, scale }: Fitted,
  motion: Motion,
  seconds: number,
  color: string,
): void {
  const { joints, bones, sample_fps, n_samples } = motion.head;
  const frame = Math.round(seconds * sample_fps);
  if (frame < 0 || frame >= n_samples) return;
  const pose = new Float32Array(3 * joints.length);
  poseAt(motion, frame / sample_fps, pose);
  const at = (i: number): [number, number] => [
    left + scale * pose[3 * i]!,
    top + scale * pose[3 * i + 1]!,
  ];
  const sureness = (...points: number[]): number =>
    Math.min(...points.map((i) => pose[3 * i + 2]!)) < SURE ? FAINT : 1;
  const drawn = new Set(bones.flat().filter((i) => !Number.isNaN(pose[3 * i]!)));
  pen.lineCap = "round";
  // A dark line below makes the coloured one seen on any picture.
  for (const [width, style] of [
    [6, "rgb(0 0 0 / 55%)"],
    [3.5, color],
  ] as const) {
    pen.lineWidth = width;
    pen.strokeStyle = pen.fillStyle = style;
    for (const [a, b] of bones) {
      if (!drawn.has(a) || !drawn.has(b)) continue;
      pen.globalAlpha = sureness(a, b);
      pen.beginPath();
      pen.moveTo(...at(a));
      pen.lineTo(...at(b));
      pen.stroke();
    }
    for (const i of drawn) {
      pen.globalAlpha = sureness(i);
      pen.beginPath();
      pen.arc(...at(i), width * 0.75, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.globalAlpha = 1;
}

/** Draw keypoints over the picture of a video. */
import type { Picture } from "../messages";
import { computePose, type Motion } from "../motion";

/** Position of a picture that is scaled to fit a box, and box pixels per picture pixel. */
interface PictureFit {
  left: number;
  top: number;
  scale: number;
}

export function fitPicture(
  picture: Pick<Picture, "width" | "height">,
  width: number,
  height: number,
): PictureFit {
  const scale = Math.min(width / picture.width, height / picture.height);
  const left = (width - scale * picture.width) / 2;
  return { left, top: (height - scale * picture.height) / 2, scale };
}

const MIN_CERTAINTY = 50; // percent; keypoints below are drawn faintly
const FAINT_ALPHA = 0.35;

/** Draw the keypoints of the frame nearest to a time (seconds of the recording). */
export function drawKeypoints(
  pen: CanvasRenderingContext2D,
  { left, top, scale }: PictureFit,
  motion: Motion,
  seconds: number,
  color: string,
): void {
  const { joints, bones, sample_fps, n_samples } = motion.head;
  const frame = Math.round(seconds * sample_fps);
  if (frame < 0 || frame >= n_samples) return;
  const pose = new Float32Array(3 * joints.length);
  computePose(motion, frame / sample_fps, pose);
  const at = (i: number): [number, number] => [
    left + scale * pose[3 * i]!,
    top + scale * pose[3 * i + 1]!,
  ];
  const chooseAlpha = (...points: number[]): number =>
    Math.min(...points.map((i) => pose[3 * i + 2]!)) < MIN_CERTAINTY ? FAINT_ALPHA : 1;
  const drawn = new Set(bones.flat().filter((i) => !Number.isNaN(pose[3 * i]!)));
  pen.lineCap = "round";
  // A dark outline makes the coloured line visible on any picture.
  for (const [width, style] of [
    [6, "rgb(0 0 0 / 55%)"],
    [3.5, color],
  ] as const) {
    pen.lineWidth = width;
    pen.strokeStyle = pen.fillStyle = style;
    for (const [a, b] of bones) {
      if (!drawn.has(a) || !drawn.has(b)) continue;
      pen.globalAlpha = chooseAlpha(a, b);
      pen.beginPath();
      pen.moveTo(...at(a));
      pen.lineTo(...at(b));
      pen.stroke();
    }
    for (const i of drawn) {
      pen.globalAlpha = chooseAlpha(i);
      pen.beginPath();
      pen.arc(...at(i), width * 0.75, 0, 2 * Math.PI);
      pen.fill();
    }
  }
  pen.globalAlpha = 1;
}

/** Offer to estimate the poses of videos, then show the progress. */
import { formatCount } from "../../util";
import { Button } from "../../layout/controls";
import type { Listing, PosesProgress } from "../../messages";
import { useStudio } from "../context";

/** @param all whether to offer all videos of the folder, or only the one to be opened */
export function PosesOffer({ all = false }: { all?: boolean }) {
  const { poses, session } = useStudio();
  const { value: progress } = poses.progress;
  const { value: videos } = poses.videos;
  const { value: asked } = poses.requestedVideo;
  const { value: install } = poses.install;
  const estimate = (which: readonly Listing[]): void => void poses.start(which.map(({ id }) => id));
  if (!(all ? videos.length > 0 || progress : asked)) return null;
  const subject = all ? formatCount(videos.length, "video") : asked!.name;
  const has = all && videos.length !== 1 ? "have" : "has";
  return (
    <div class={`poses-offer ${all ? "of-folder" : "of-video"}`}>
      {progress ? (
        <>
          <EstimationProgress {...progress} />
          <Button onClick={() => void poses.cancel()}>Cancel</Button>
        </>
      ) : (
        <p>
          {subject} {has} no poses yet.{" "}
          {install
            ? `${install}.`
            : "Estimating them can take some minutes; everything stays on this machine."}
        </p>
      )}
      {!progress && !install && (
        <Button class="primary" onClick={() => estimate(all ? videos : [asked!])}>
          Estimate poses
        </Button>
      )}
      {!progress && !install && !all && videos.length > 1 && (
        <Button onClick={() => estimate(videos)}>Of all {videos.length} videos</Button>
      )}
      {!all && !progress && session.store.active.value && (
        <Button onClick={() => (session.videoWithoutPoses.value = null)}>Not now</Button>
      )}
    </div>
  );
}

function EstimationProgress({ name, share, pace, done, all }: PosesProgress) {
  const percent = share === null ? "" : `${Math.round(100 * share)} %, `;
  return (
    <p role="status">
      Estimating the poses in {name}: {percent}
      {pace ? `${pace.toFixed(1)} frames/s` : "starting"}
      {all > 1 && `; ${done} of ${all} videos done`}
      <progress max={1} {...(share === null ? {} : { value: share })} aria-label="Poses" />
    </p>
  );
}

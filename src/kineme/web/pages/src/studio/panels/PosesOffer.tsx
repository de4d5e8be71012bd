/** Offer to estimate the poses of videos, then show the progress. */
import { formatCount } from "../../util";
import { Button } from "../../layout/controls";
import type { PosesProgress } from "../../messages";
import { useStudio } from "../context";

/** @param all whether to offer all videos of the folder, or only the one to be opened */
export function PosesOffer({ all = false }: { all?: boolean }) {
  const { poses, session } = useStudio();
  const { value: progress } = poses.progress;
  const { value: videos } = poses.videos;
  const { value: asked } = poses.requestedVideo;
  if (!(all ? videos.length > 0 || progress : asked)) return null;
  const subject = all ? formatCount(videos.length, "video") : asked!.name;
  const has = all && videos.length !== 1 ? "have" : "has";
  return (
    <div class={`poses-offer ${all ? "of-folder" : "of-video"}`}>
      {progress ? (
        <EstimationProgress {...progress} />
      ) : (
        <p>
          {subject} {has} no poses yet.{" "}
          {poses.install.value
            ? `${poses.install.value}.`
            : "Estimating them can take some minutes; everything stays on this machine."}
        </p>
      )}
      {progress ? (
        <Button onClick={() => void poses.cancel()}>Cancel</Button>
      ) : (
        !poses.install.value && (
          <>
            {asked && !all && (
              <Button class="primary" onClick={() => void poses.start([asked.id])}>
                Estimate poses
              </Button>
            )}
            {(all || videos.length > 1) && (
              <Button
                class={all ? "primary" : ""}
                onClick={() => void poses.start(videos.map(({ id }) => id))}
              >
                {all ? "Estimate poses" : `Of all ${videos.length} videos`}
              </Button>
            )}
          </>
        )
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

/** Show a search hit with an animated figure, its place and distance, and buttons to judge it. */
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import type { LibraryHit } from "../../messages";
import { buildPageAddress } from "../server/address";
import { Figure } from "./Figure";
import { getHitKey } from "./hits";
import type { LibraryPage } from "./libraryPage";
import { Button } from "../../layout/controls";

const prefersReducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

export function HitCard({ page, hit }: { page: LibraryPage; hit: LibraryHit }): JSX.Element {
  const looked = useSignal(false);
  const right = page.verdicts.value.get(getHitKey(hit))?.right;
  const front = page.hits.value[page.frontIndex.value] === hit;
  const { recording, start_s, stop_s, cluster, label, name } = hit;
  const id = page.state.value?.recordings.find((each) => each.recording === recording)?.id;
  const time = `${start_s.toFixed(2)} to ${stop_s.toFixed(2)} s`;
  const look = (at: boolean) => (): void =>
    void (looked.value = at && !prefersReducedMotion.matches);
  return (
    <li
      class={`card hit ${front ? "front" : ""} ${right === undefined ? "" : right ? "yes" : "no"}`}
      tabIndex={0}
      aria-label={`${recording}, ${time}`}
      onPointerEnter={look(true)}
      onPointerLeave={look(false)}
      onFocus={() => {
        page.frontKey.value = getHitKey(hit);
        look(true)();
      }}
      onBlur={look(false)}
    >
      <Figure
        sketches={page.sketches}
        span={hit}
        cluster={cluster}
        playing={page.playing.value || looked.value}
      />
      <p class="name">
        {id ? <a href={buildPageAddress(page.api.token, id, start_s)}>{recording}</a> : recording}
      </p>
      <p class="quiet number">
        {time}
        <br />
        distance {hit.distance.toFixed(2)}, {cluster < 0 ? "in no cluster" : `cluster ${cluster}`}{" "}
        {label}
      </p>
      {name && <p class="hit-name">{name}</p>}
      <div class="card-tools">
        <Button
          aria-pressed={right === true}
          aria-label={`Yes: ${recording}, ${time}`}
          onClick={() => page.judge(hit, true)}
        >
          ✓ Yes
        </Button>
        <Button
          aria-pressed={right === false}
          aria-label={`No: ${recording}, ${time}`}
          onClick={() => page.judge(hit, false)}
        >
          ✗ No
        </Button>
        <Button
          title="Find more like this one"
          aria-label={`Find more like ${recording}, ${time}`}
          onClick={() => {
            page.span.value = { recording, start_s, stop_s };
            void page.startSearch({
              title: `${recording} ${time}`,
              like: [{ recording, start_s, stop_s }],
              unlike: [],
            });
          }}
        >
          More…
        </Button>
      </div>
    </li>
  );
}

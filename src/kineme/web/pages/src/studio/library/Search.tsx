/** Search by example and judge the hits. */
import { useEffect, useRef } from "preact/hooks";
import { Button, Checkbox, Form, NameInput, NumberInput, Toggle } from "../../layout/controls";
import { saveFile } from "../server/api";
import { formatSeconds, getHitKey, toCsv, toJson, type LibraryPage } from "./libraryPage";
import type { LibraryHit, Span } from "../../messages";
import { useSignal } from "@preact/signals";
import { buildPageAddress } from "../server/address";
import { Figure } from "./Figure";
import { listen } from "../../util";
import { isPlayerKey } from "../../page";

export function Search({ page }: { page: LibraryPage }) {
  const { value: question } = page.question;
  const { value: hits } = page.hits;
  const cards = useRef<HTMLUListElement>(null);
  useEffect(() => listenToHitKeys(page, () => cards.current), [page]);
  const count = page.confirmed.value.length + page.refused.value.length;
  return (
    <>
      <SpanForm page={page} />
      {question && (
        <div class="tools" role="status">
          {page.searching.value && <span class="busy" aria-label="Searching" />}
          <strong>Like {question.title}</strong>
          <span class="quiet">{page.searching.value ? "searching…" : `${hits.length} found`}</span>
        </div>
      )}
      {hits.length > 0 && (
        <div class="tools">
          <Toggle on={page.playing}>{page.playing.value ? "Stop all" : "Play all"}</Toggle>
          <Downloads page={page} />
          <span class="quiet">
            Is the framed one right? <kbd>Y</kbd> yes, <kbd>N</kbd> no, arrow keys for the next.
          </span>
        </div>
      )}
      {count > 0 && <Verdicts page={page} />}
      {question && !page.searching.value && !hits.length && (
        <p class="quiet">Nothing is that near: try a larger distance.</p>
      )}
      <ul class="cards hits" ref={cards}>
        {hits.map((hit) => (
          <HitCard key={getHitKey(hit)} page={page} hit={hit} />
        ))}
      </ul>
    </>
  );
}

/** Show how many hits were judged, and refine the search or name them. */
function Verdicts({ page }: { page: LibraryPage }) {
  const [yes, no] = [page.confirmed.value.length, page.refused.value.length];
  return (
    <section class="said" aria-label="What you said">
      <p>
        {yes} confirmed, {no} refused. Search again, with those confirmed as further examples and
        without what is more like those refused?
      </p>
      <Button class="primary" onClick={() => void page.refine()}>
        Search again with these
      </Button>
      {yes > 0 && (
        <label>
          Name {yes === 1 ? "it" : `these ${yes}`} alone, in the {yes === 1 ? "table" : "tables"}{" "}
          beside {yes === 1 ? "its recording" : "their recordings"}:{" "}
          <NameInput
            value=""
            placeholder="a name of its own"
            aria-label="Name of the confirmed alone"
            onName={(name) => void page.nameHits(name)}
          />
          {page.naming.value && <span class="busy" role="status" aria-label="Naming" />}
        </label>
      )}
      {page.news.value && <p role="status">{page.news.value}</p>}
      {page.shares.value.map(([cluster, n]) =>
        cluster < 0 ? (
          <p key={cluster}>
            {n} of the confirmed {n === 1 ? "is" : "are"} in no cluster.
          </p>
        ) : (
          <label key={cluster}>
            {n} of the confirmed {n === 1 ? "is" : "are"} in cluster {cluster}. Name all of it:{" "}
            <NameInput
              value={page.getClusterName(cluster)}
              aria-label={`Name of cluster ${cluster}, which has ${n} of the confirmed`}
              onName={(name) => void page.edit({ kind: "name", cluster, name })}
            />
          </label>
        ),
      )}
    </section>
  );
}

function Downloads({ page }: { page: LibraryPage }) {
  const write = (name: string, text: typeof toCsv): void => {
    const verdicts = page.verdicts.peek();
    const content = text(page.hits.peek(), (hit) => verdicts.get(getHitKey(hit))?.right);
    saveFile({ name, data: new Blob([content], { type: "text/plain;charset=utf-8" }) });
  };
  return (
    <span class="group">
      <Button onClick={() => write("hits.csv", toCsv)}>CSV</Button>
      <Button
        title="One object a line, as kineme library search --json"
        onClick={() => write("hits.jsonl", toJson)}
      >
        JSON
      </Button>
    </span>
  );
}

/** Edit the searched span and the largest distance. */
function SpanForm({ page }: { page: LibraryPage }) {
  const recordings = (page.state.value?.recordings ?? []).filter((each) => each.vocabulary);
  const first = recordings[0];
  const span: Span = page.span.value ?? {
    recording: first?.recording ?? "",
    start_s: 0,
    stop_s: Math.min(3, first?.duration_s ?? 3),
  };
  const change = (some: Partial<Span>): void => void (page.span.value = { ...span, ...some });
  const exists = recordings.some((each) => each.recording === span.recording);
  const { start_s, stop_s, recording } = span;
  const valid = exists && start_s >= 0 && stop_s > start_s;
  return (
    <Form
      class="tools"
      onSubmit={() => {
        const given = page.span.value ?? span; // Enter also commits the focused field
        const title = `${given.recording} ${given.start_s} to ${given.stop_s} s`;
        if (valid) void page.startSearch({ title, like: [given], unlike: [] });
      }}
    >
      <label>
        Recording{" "}
        <input
          type="text"
          list="library-recordings"
          value={recording}
          onInput={(event) => change({ recording: event.currentTarget.value })}
        />
      </label>
      <datalist id="library-recordings">
        {recordings.slice(0, 500).map((each) => (
          <option key={each.recording} value={each.recording}>
            {formatSeconds(each.duration_s)}
          </option>
        ))}
      </datalist>
      <Field label="from, s" value={start_s} change={(start_s) => change({ start_s })} />
      <Field label="to, s" value={stop_s} change={(stop_s) => change({ stop_s })} />
      <Field
        label="largest distance"
        value={page.threshold.value}
        change={(threshold) => {
          if (threshold > 0) page.threshold.value = threshold;
        }}
      />
      <Checkbox checked={page.mirror.value} onCheck={(checked) => (page.mirror.value = checked)}>
        mirrored, too
      </Checkbox>
      <Button type="submit" class="primary" disabled={!valid}>
        Find more like this
      </Button>
      {page.question.value && (
        <Button onClick={() => void page.searchAgain()}>The last search again</Button>
      )}
    </Form>
  );
}

function Field(props: { label: string; value: number; change: (value: number) => void }) {
  return (
    <label>
      {props.label} <NumberInput step="any" min={0} value={props.value} onNumber={props.change} />
    </label>
  );
}

const prefersReducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

/** Show a search hit with an animated figure, its place and distance, and buttons to judge it. */
function HitCard({ page, hit }: { page: LibraryPage; hit: LibraryHit }) {
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

/** Steps to the next hit. */
const SIDEWAYS: Record<string, number> = { y: 1, n: 1, arrowright: 1, arrowleft: -1 };

/** Listen to the keyboard and return a function that stops; `cards` contains the hits. */
function listenToHitKeys(page: LibraryPage, cards: () => HTMLElement | null): () => void {
  const onKey = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.altKey || event.metaKey || !isPlayerKey(event)) return;
    const at = page.frontIndex.peek();
    const hit = page.hits.peek()[at];
    const key = event.key.toLowerCase();
    if (!hit) return;
    // Up and down scroll the page unless a card has the focus.
    const onCard = cards()?.contains(event.target as Node);
    const steps = onCard ? { ...SIDEWAYS, arrowdown: 1, arrowup: -1 } : SIDEWAYS;
    const by = steps[key];
    if (by === undefined) return;
    if (key === "y" || key === "n") page.judge(hit, key === "y");
    const next = cards()?.children[at + by];
    if (next instanceof HTMLElement) next.focus(); // the focus handler makes it the current hit
    event.preventDefault();
  };
  return listen(window, { keydown: onKey });
}

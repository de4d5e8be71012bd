/** Search by example and judge the hits. */
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { NameInput } from "../../layout/NameInput";
import { saveFile } from "../server/saveFile";
import { HitCard } from "./HitCard";
import { listenToHitKeys } from "./hitKeys";
import { toCsv, toJson, getHitKey } from "./hits";
import type { LibraryPage } from "./libraryPage";
import { SpanForm } from "./SpanForm";
import { Button } from "../../layout/controls";

export function Search({ page }: { page: LibraryPage }): JSX.Element {
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
          <Button
            aria-pressed={page.playing.value}
            onClick={() => (page.playing.value = !page.playing.value)}
          >
            {page.playing.value ? "Stop all" : "Play all"}
          </Button>
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
function Verdicts({ page }: { page: LibraryPage }): JSX.Element {
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
            label="Name of the confirmed alone"
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
              label={`Name of cluster ${cluster}, which has ${n} of the confirmed`}
              onName={(name) => void page.edit({ kind: "name", cluster, name })}
            />
          </label>
        ),
      )}
    </section>
  );
}

function Downloads({ page }: { page: LibraryPage }): JSX.Element {
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

/** Show where a result comes from and how long each stage took. */
import type { ComponentChildren } from "preact";
import { Table } from "../layout/tables";
import { useStore, type Store } from "../store";
import { formatCounts } from "../segments";
import { formatTime } from "../view";

export function About() {
  const store = useStore();
  const recording = store.recording.value;
  if (!recording) return null;
  const { provenance, timings } = recording.segmentation;
  const { notes, parameters, ...rest } = provenance;
  return (
    <div class="about">
      <dl>
        <Fact name="Recording">{recording.name}</Fact>
        <Fact name="Length">
          {formatTime(store.duration.value, 2)} ({recording.n_frames} frames at{" "}
          {formatNumber(recording.fps)} Hz)
        </Fact>
        <Fact name="Found">{formatCounts(recording.segmentation)}</Fact>
        {Object.entries(rest).map(([key, value]) => (
          <Fact key={key} name={key}>
            <Value value={value} />
          </Fact>
        ))}
      </dl>
      <SentenceList title="Warnings" sentences={recording.warnings} />
      <SentenceList title="Notes" sentences={Array.isArray(notes) ? notes.map(String) : []} />
      <Timings timings={timings} />
      {isObject(parameters) && (
        <details>
          <summary>Parameters</summary>
          <Value value={parameters} />
        </details>
      )}
    </div>
  );
}

/** Return the tab's title, with the number of warnings if there are any. */
export function getAboutTitle(store: Store): string {
  const warnings = store.recording.value?.warnings.length ?? 0;
  return warnings ? `About ⚠ ${warnings}` : "About";
}

function Fact({ name, children }: { name: string; children: ComponentChildren }) {
  return (
    <>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </>
  );
}

/** Render any JSON value; objects become definition lists. */
function Value({ value }: { value: unknown }) {
  if (isObject(value))
    return (
      <dl>
        {Object.entries(value).map(([key, each]) => (
          <Fact key={key} name={key.replaceAll("_", " ")}>
            <Value value={each} />
          </Fact>
        ))}
      </dl>
    );
  if (Array.isArray(value)) return <>{value.map((each) => String(each)).join(", ")}</>;
  if (value === null) return <>none</>;
  if (typeof value === "string") return <>{value}</>;
  return <>{typeof value === "number" ? formatNumber(value) : JSON.stringify(value)}</>;
}

function SentenceList(props: { title: string; sentences: readonly string[] }) {
  const { title, sentences } = props;
  if (sentences.length === 0) return null;
  return (
    <section>
      <h2>{title}</h2>
      <ul>
        {sentences.map((sentence) => (
          <li key={sentence}>{sentence}</li>
        ))}
      </ul>
    </section>
  );
}

function Timings({ timings }: { timings: Record<string, number> }) {
  const stages = Object.entries(timings);
  if (stages.length === 0) return null;
  const most = Math.max(...stages.map(([, seconds]) => seconds), 1e-9);
  const total = stages.reduce((sum, [, seconds]) => sum + seconds, 0);
  return (
    <section>
      <h2>Timings, {total.toFixed(2)} s in all</h2>
      <Table
        class="timings"
        rows={stages.map(([stage, seconds]) => ({
          key: stage,
          head: stage,
          cells: [
            <span class="number">{seconds.toFixed(3)} s</span>,
            <span class="timing-bar" style={{ width: `${(100 * seconds) / most}%` }} />,
          ],
        }))}
      />
    </section>
  );
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function formatNumber(value: number): string {
  return String(Number(value.toPrecision(6)));
}

/** Show a table of keys and their actions. */
export function Keys({ keys }: { keys: readonly (readonly [string, string])[] }) {
  const rows = keys.map(([key, what]) => ({ key, head: <kbd>{key}</kbd>, cells: [what] }));
  return <Table class="keys" rows={rows} />;
}

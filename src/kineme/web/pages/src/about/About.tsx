/** Where the result comes from, and what it cost. */
import type { ComponentChildren, JSX } from "preact";
import { useStore } from "../context";
import { countsOf } from "../segments";
import type { Store } from "../store";
import { clock } from "../view";

export function About(): JSX.Element | null {
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
          {clock(store.duration.value, 2)} ({recording.n_frames} frames at {rounded(recording.fps)}{" "}
          Hz)
        </Fact>
        <Fact name="Found">{countsOf(recording.segmentation)}</Fact>
        {Object.entries(rest).map(([key, value]) => (
          <Fact key={key} name={key}>
            <Value of={value} />
          </Fact>
        ))}
      </dl>
      <Sentences title="Warnings" of={recording.warnings} />
      <Sentences title="Notes" of={Array.isArray(notes) ? notes.map(String) : []} />
      <Timings of={timings} />
      {isRecord(parameters) && (
        <details>
          <summary>Parameters</summary>
          <Value of={parameters} />
        </details>
      )}
    </div>
  );
}

/** The title of its tab, with a sign where there is something to warn of. */
export function aboutTitle(store: Store): string {
  const warnings = store.recording.value?.warnings.length ?? 0;
  return warnings ? `About ⚠ ${warnings}` : "About";
}

function Fact({ name, children }: { name: string; children: ComponentChildren }): JSX.Element {
  return (
    <>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </>
  );
}

/** Anything JSON can hold: objects as lists of facts. */
function Value({ of }: { of: unknown }): JSX.Element {
  if (isRecord(of))
    return (
      <dl>
        {Object.entries(of).map(([key, value]) => (
          <Fact key={key} name={key.replaceAll("_", " ")}>
            <Value of={value} />
          </Fact>
        ))}
      </dl>
    );
  if (Array.isArray(of)) return <>{of.map((each) => String(each)).join(", ")}</>;
  if (of === null) return <>none</>;
  if (typeof of === "string") return <>{of}</>;
  return <>{typeof of === "number" ? rounded(of) : JSON.stringify(of)}</>;
}

function Sentences({ title, of }: { title: string; of: readonly string[] }): JSX.Element | null {
  if (of.length === 0) return null;
  return (
    <section>
      <h2>{title}</h2>
      <ul>
        {of.map((sentence) => (
          <li key={sentence}>{sentence}</li>
        ))}
      </ul>
    </section>
  );
}

function Timings({ of }: { of: Record<string, number> }): JSX.Element | null {
  const stages = Object.entries(of);
  if (stages.length === 0) return null;
  const most = Math.max(...stages.map(([, seconds]) => seconds), 1e-9);
  const total = stages.reduce((sum, [, seconds]) => sum + seconds, 0);
  return (
    <section>
      <h2>Timings, {total.toFixed(2)} s in all</h2>
      <table class="timings">
        <tbody>
          {stages.map(([stage, seconds]) => (
            <tr key={stage}>
              <th scope="row">{stage}</th>
              <td class="number">{seconds.toFixed(3)} s</td>
              <td>
                <span class="timing-bar" style={{ width: `${(100 * seconds) / most}%` }} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function rounded(value: number): string {
  return String(Number(value.toPrecision(6)));
}

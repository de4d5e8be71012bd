/** Show a card for each cluster of a library, with an editable name. */
import { formatCount } from "../../util";
import { useSignal } from "@preact/signals";
import { getClusterColor } from "../../colors";
import {
  Button,
  Checkbox,
  Dialog,
  NameInput,
  Select,
  Swatch,
  toggleMember,
} from "../../layout/controls";
import type { LibraryCluster } from "../../messages";
import { Figure } from "./Figure";
import { formatSeconds, sortClusters, type LibraryPage, type Order } from "./libraryPage";
import type { JSX } from "preact";

const PAGE_SIZE = 120;
const ORDERS = [
  ["seconds", "by how long"],
  ["count", "by how many"],
  ["name", "by name"],
  ["unsure", "by how unsure"],
] as const;

export function ClusterCards({ page }: { page: LibraryPage }) {
  const order = useSignal<Order>("seconds");
  const shown = useSignal(PAGE_SIZE);
  const clusters = sortClusters(page.state.value?.clusters ?? [], order.value);
  return (
    <>
      <div class="tools">
        <label>
          Order{" "}
          <Select
            value={order.value}
            options={ORDERS}
            onSelect={(chosen) => (order.value = chosen)}
          />
        </label>
        <span class="quiet">A name is kept at once, and stays through every build.</span>
        <TableTools page={page} />
      </div>
      {!clusters.length && <p class="quiet">Nothing repeats itself in these recordings.</p>}
      <ul class="cards">
        {clusters.slice(0, shown.value).map((cluster) => (
          <ClusterCard key={cluster.cluster} page={page} cluster={cluster} />
        ))}
      </ul>
      {clusters.length > shown.value && (
        <Button onClick={() => (shown.value += PAGE_SIZE)}>Show more of {clusters.length}</Button>
      )}
    </>
  );
}

/** Undo edits and write cluster numbers and names to corrected tables. */
function TableTools({ page }: { page: LibraryPage }) {
  const { undo = "", recordings = [] } = page.state.value ?? {};
  const { text, others } = page.tablesNews.value;
  const saved = recordings.filter(({ status }) => status === "corrected" || status === "checked");
  return (
    <>
      <Button
        disabled={!undo}
        title={undo ? `Take back: ${undo}` : "Nothing to take back"}
        onClick={() => void page.edit({ kind: "undo" })}
      >
        ↶ Undo
      </Button>
      {saved.length > 0 && (
        <Button
          title="Recordings that nobody has corrected have them anyway. Segments stay; undo is in each recording."
          onClick={() => void page.updateTables(false)}
        >
          Numbers and names to {formatCount(saved.length, "corrected recording")}
        </Button>
      )}
      {others > 0 && (
        <Button onClick={() => void page.updateTables(true)}>
          Replace {formatCount(others, "other name")}, too
        </Button>
      )}
      <span role="status">{text}</span>
    </>
  );
}

function ClusterCard(props: { page: LibraryPage; cluster: LibraryCluster }) {
  const { page, cluster: it } = props;
  const dialog = useSignal<"merge" | "split" | null>(null);
  const called = it.label || `cluster ${it.cluster}`;
  const close = (): void => void (dialog.value = null);
  const n = it.recordings.length;
  const others = (page.state.value?.clusters ?? []).filter(
    (other) => other.cluster !== it.cluster && other.vocabulary === it.vocabulary,
  );
  return (
    <li class="card">
      <div class="card-head">
        <Swatch color={getClusterColor(it.cluster)} />
        <span class="number">{it.cluster}</span>
        <NameInput
          value={it.label}
          aria-label={`Name of cluster ${it.cluster}`}
          onName={(name) => void page.edit({ kind: "name", cluster: it.cluster, name })}
        />
      </div>
      <ClusterFigure page={page} cluster={it} />
      <p class="quiet number">
        {it.repetitions > 0 &&
          `${formatCount(it.repetitions, "repetition")} of ${formatSeconds(it.typical_s)}; `}
        {formatCount(it.activities, "activity", "activities")}
        {it.repetitions === 0 && ` of ${formatSeconds(it.typical_s)}`}, {formatSeconds(it.seconds)}{" "}
        in all, in {formatCount(n, "recording")}
        {it.unsure > 0 && <span class="unsure"> · {it.unsure} unsure</span>}
      </p>
      <div class="card-tools">
        <Button
          aria-label={`Find more like this: ${called}`}
          onClick={() =>
            void page.startSearch({ title: called, like: [], unlike: [], cluster: it.cluster })
          }
        >
          Find more like this
        </Button>
        <Button
          aria-label={`Merge others into ${called}`}
          disabled={!others.length}
          onClick={() => (dialog.value = "merge")}
        >
          Merge…
        </Button>
        <Button
          aria-label={`Split ${called}`}
          disabled={n < 2}
          title={n < 2 ? "It is in one recording only" : undefined}
          onClick={() => (dialog.value = "split")}
        >
          Split…
        </Button>
      </div>
      {dialog.value === "merge" && (
        <ChoiceDialog
          title={`Merge into ${called}`}
          say="Those chosen become part of it, in every recording; their own names and numbers go."
          action="Merge"
          close={close}
          choices={others.map((other) => ({
            value: other.cluster,
            text: `${other.cluster} ${other.label}`,
            picture: <ClusterFigure page={page} cluster={other} />,
          }))}
          choose={(chosen) => page.edit({ kind: "merge", cluster: it.cluster, others: chosen })}
        />
      )}
      {dialog.value === "split" && (
        <ChoiceDialog
          title={`Split ${called}`}
          say="What it has in the recordings chosen, some but not all, becomes a cluster of its own."
          action="Split"
          most={n - 1}
          close={close}
          choices={it.recordings.map((row) => {
            const { recording } = page.state.value!.recordings[row]!;
            return { value: recording, text: recording };
          })}
          choose={(recordings) => page.edit({ kind: "split", cluster: it.cluster, recordings })}
        />
      )}
    </li>
  );
}

/** Draw the most typical segment of a cluster. */
function ClusterFigure(props: { page: LibraryPage; cluster: LibraryCluster }) {
  const { cluster, example, start_s, stop_s } = props.cluster;
  const span = { recording: example, start_s, stop_s };
  return <Figure sketches={props.page.sketches} span={span} cluster={cluster} />;
}

/** Choose some entries of a list, at most `most`, for one action. */
function ChoiceDialog<Value>(props: {
  title: string;
  say: string;
  action: string;
  choices: { value: Value; text: string; picture?: JSX.Element }[];
  most?: number;
  choose: (chosen: Value[]) => Promise<unknown>;
  close: () => void;
}) {
  const { title, say, action, choices, most = choices.length, choose, close } = props;
  const chosen = useSignal<ReadonlySet<Value>>(new Set());
  const n = chosen.value.size;

  return (
    <Dialog title={title} close={close}>
      <p>{say}</p>
      <ul class="choice-list">
        {choices.map(({ value, text, picture }) => (
          <li key={value}>
            <Checkbox
              checked={chosen.value.has(value)}
              onCheck={() => (chosen.value = toggleMember(chosen.value, value))}
            >
              {text}
              {picture}
            </Checkbox>
          </li>
        ))}
      </ul>
      <Button
        class="primary"
        disabled={!n || n > most}
        onClick={() => void choose([...chosen.value]).then(close)}
      >
        {action} {n || ""}
      </Button>
    </Dialog>
  );
}

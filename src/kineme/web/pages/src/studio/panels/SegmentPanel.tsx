/** The segment one works on: its times, name and cluster, and the name of the cluster. */
import type { JSX } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import { useStudio } from "../context";
import { placeOf } from "../editing/commands";
import { clusterColor, NO_COLOR } from "../../colors";
import type { Kind, Segment } from "../../messages";
import { NameInput } from "../../layout/NameInput";
import { durationOf, nameOf } from "../../segments";
import { confidenceOf } from "../../confidence";
import { counted } from "../../counted";
import type { Session } from "../session";
import { Comment } from "./Comment";
import { Vocabulary } from "./Vocabulary";
import { Checkbox, Select } from "../../layout/controls";

export function SegmentPanel(): JSX.Element {
  const { session, editor, review } = useStudio();
  const segment = editor.segment.value;
  if (!segment) {
    const hint = session.opening.value
      ? "The segments come once the recording has been read."
      : "Open a recording to see its segments.";
    return <p class="hint quiet">{hint}</p>;
  }
  const { store } = session;
  const table = store.table.value;
  const called = table?.cluster_names[segment.cluster] ?? "";
  const label = segment.label !== called ? segment.label : "";
  const chosen = store.selected.value === segment;
  const confidence = table && confidenceOf(table).get(segment);
  return (
    <div class="segment-panel">
      <p class="times number">
        <span class="swatch" style={{ background: store.colorOf(segment) ?? NO_COLOR }} />{" "}
        <b>{nameOf(segment)}</b>{" "}
        <span class="quiet">
          {segment.level} {chosen ? "selected" : "at the playhead"}
        </span>
        <br />
        {segment.start_s.toFixed(2)} – {segment.stop_s.toFixed(2)} s{" "}
        <span class="quiet">({durationOf(segment).toFixed(2)} s)</span>
        <br />
        <span class="quiet">
          frames {segment.start_frame} – {segment.stop_frame}
          {confidence?.text && <span title={confidence.why}>, {confidence.text}</span>}
        </span>
      </p>
      <NameField
        title="Name of its own"
        placeholder={called ? `called “${called}” by its cluster` : "no name"}
        value={label}
        names={namesOf(session)}
        naming="segment"
        onName={(label) => editor.name(segment, label, table)}
      />
      <Checkbox
        checked={review.isChecked(segment)}
        onCheck={(checked) => editor.check([segment], checked)}
      >
        Checked: no new segmentation changes it
      </Checkbox>
      <div class="pair">
        <label class="field">
          <span>Kind</span>
          <Select<Kind>
            value={segment.kind}
            options={[
              [segment.level, segment.level],
              ["transition", "transition"],
            ]}
            onSelect={(to) => editor.edit({ kind: "set_kind", ...placeOf(segment), to })}
          />
        </label>
        <label class="field">
          <span>Cluster</span>
          <span class="swatch" style={{ background: clusterColor(segment.cluster) }} />
          <ClusterChoice segment={segment} />
        </label>
      </div>
      {segment.cluster >= 0 && (
        <NameField
          title={`Name of cluster ${segment.cluster}, of ${bulkOf(session, segment.cluster)}`}
          placeholder="no name"
          value={called}
          names={namesOf(session)}
          naming="cluster"
          onName={(label) => editor.edit({ kind: "name_cluster", cluster: segment.cluster, label })}
        />
      )}
      <Comment segment={segment} table={table} />
      <Vocabulary />
    </div>
  );
}

function ClusterChoice({ segment }: { segment: Segment }): JSX.Element {
  const { session, editor } = useStudio();
  const rows = session.store.table.value?.segments ?? [];
  const next = rows.reduce((most, row) => Math.max(most, row.cluster), -1) + 1;
  const clusters = new Set([-1, next, ...rows.map((row) => row.cluster)]);
  const title = (id: number): string => {
    const label = session.store.table.value?.cluster_names[id];
    if (id < 0) return "none";
    if (id === next) return `${id} (new)`;
    return label ? `${id}: ${label}` : String(id);
  };
  return (
    <Select
      label="Cluster of the segment"
      value={segment.cluster}
      options={[...clusters].sort((a, b) => a - b).map((id) => [id, title(id)])}
      onSelect={(cluster) => editor.edit({ kind: "set_cluster", ...placeOf(segment), cluster })}
    />
  );
}

/** How many segments the name of a cluster is for, and how many keep their own. */
function bulkOf(session: Session, cluster: number): string {
  const table = session.store.table.value;
  const called = table?.cluster_names[cluster] ?? "";
  const members = table?.segments.filter((row) => row.cluster === cluster) ?? [];
  const named = members.filter((row) => row.label && row.label !== called).length;
  const all = counted(members.length - named, "segment");
  return named ? `${all}; ${named} with their own name` : all;
}

interface NameProps {
  title: string;
  placeholder: string;
  value: string;
  /** Names in use, offered while one types. */
  names: string[];
  /** Which name it is, as the editor says when one wants to type it. */
  naming: "segment" | "cluster";
  onName: (label: string) => void;
}

function NameField({ title, placeholder, value, names, naming, onName }: NameProps): JSX.Element {
  const { editor } = useStudio();
  const field = useRef<HTMLInputElement>(null);
  const focus = editor.naming.value === naming;
  useLayoutEffect(() => {
    if (!focus) return;
    field.current?.focus();
    field.current?.select();
    editor.naming.value = null;
  }, [focus, editor]);
  const list = `names-${naming}`;
  return (
    <label class="field">
      <span>{title}</span>
      <NameInput {...{ field, value, placeholder, list, onName }} />
      <datalist id={list}>
        {names.map((name) => (
          <option key={name} value={name} />
        ))}
      </datalist>
    </label>
  );
}

function namesOf(session: Session): string[] {
  const rows = session.store.table.value?.segments ?? [];
  return [...new Set(rows.map((row) => row.label))].filter(Boolean).sort();
}

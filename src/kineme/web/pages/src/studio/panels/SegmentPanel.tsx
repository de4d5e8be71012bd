/** Edit the segment at the playhead: name, cluster, kind and comment. */
import type { JSX } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";
import { useStudio } from "../context";
import { getTarget } from "../editing/commands";
import { getClusterColor, NO_COLOR } from "../../colors";
import type { Kind, Segment } from "../../messages";
import { NameInput } from "../../layout/NameInput";
import { getDuration, getSegmentName } from "../../segments";
import { getConfidences } from "../../confidence";
import { formatCount } from "../../formatCount";
import type { Session } from "../session";
import { Comment } from "./Comment";
import { SharedLabels } from "./SharedLabels";
import { Checkbox, Select, Swatch } from "../../layout/controls";

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
  const confidence = table && getConfidences(table).get(segment);
  return (
    <div class="segment-panel">
      <p class="times number">
        <Swatch color={store.getColor(segment) ?? NO_COLOR} /> <b>{getSegmentName(segment)}</b>{" "}
        <span class="quiet">
          {segment.level} {chosen ? "selected" : "at the playhead"}
        </span>
        <br />
        {segment.start_s.toFixed(2)} – {segment.stop_s.toFixed(2)} s{" "}
        <span class="quiet">({getDuration(segment).toFixed(2)} s)</span>
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
        names={listNames(session)}
        naming="segment"
        onName={(label) => editor.nameSegment(segment, label, table)}
      />
      <Checkbox
        checked={review.isChecked(segment)}
        onCheck={(checked) => editor.setChecked([segment], checked)}
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
            onSelect={(to) => editor.edit({ kind: "set_kind", ...getTarget(segment), to })}
          />
        </label>
        <label class="field">
          <span>Cluster</span>
          <Swatch color={getClusterColor(segment.cluster)} />
          <ClusterSelect segment={segment} />
        </label>
      </div>
      {segment.cluster >= 0 && (
        <NameField
          title={`Name of cluster ${segment.cluster}, of ${describeMembers(session, segment.cluster)}`}
          placeholder="no name"
          value={called}
          names={listNames(session)}
          naming="cluster"
          onName={(label) => editor.edit({ kind: "name_cluster", cluster: segment.cluster, label })}
        />
      )}
      <Comment segment={segment} table={table} />
      <SharedLabels />
    </div>
  );
}

function ClusterSelect({ segment }: { segment: Segment }): JSX.Element {
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
      onSelect={(cluster) => editor.edit({ kind: "set_cluster", ...getTarget(segment), cluster })}
    />
  );
}

/** Describe how many segments a cluster's name applies to and how many have their own. */
function describeMembers(session: Session, cluster: number): string {
  const table = session.store.table.value;
  const called = table?.cluster_names[cluster] ?? "";
  const members = table?.segments.filter((row) => row.cluster === cluster) ?? [];
  const named = members.filter((row) => row.label && row.label !== called).length;
  const all = formatCount(members.length - named, "segment");
  return named ? `${all}; ${named} with their own name` : all;
}

interface NameProps {
  title: string;
  placeholder: string;
  value: string;
  /** Suggestions. */
  names: string[];
  /** Which name this field edits; the editor can focus it. */
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

function listNames(session: Session): string[] {
  const rows = session.store.table.value?.segments ?? [];
  return [...new Set(rows.map((row) => row.label))].filter(Boolean).sort();
}

/** Edit the segment at the playhead: name, cluster, kind and comment. */
import { useLayoutEffect, useRef } from "preact/hooks";
import { useStudio } from "../context";
import { getTarget } from "../editing/edits";
import { getClusterColor } from "../../colors";
import type { Kind, Segment, Segments } from "../../messages";
import {
  Button,
  Checkbox,
  CloseButton,
  Field,
  Form,
  NameInput,
  Select,
  Swatch,
  TextInput,
  useDraft,
} from "../../layout/controls";
import { getDuration, getSegmentName } from "../../segments";
import { Confidence } from "../../confidence";
import { formatCount } from "../../util";
import type { Session } from "../session";
import { useSignal } from "@preact/signals";

export function SegmentPanel() {
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
  const confidence = table && new Confidence(table, segment);
  return (
    <div class="segment-panel">
      <p class="times number">
        <Swatch color={store.getColor(segment)} /> <b>{getSegmentName(segment)}</b>{" "}
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
        <Field title="Kind">
          <Select<Kind>
            value={segment.kind}
            options={[
              [segment.level, segment.level],
              ["transition", "transition"],
            ]}
            onSelect={(to) => editor.edit({ kind: "set_kind", ...getTarget(segment), to })}
          />
        </Field>
        <Field title="Cluster">
          <Swatch color={getClusterColor(segment.cluster)} />
          <ClusterSelect segment={segment} />
        </Field>
      </div>
      {segment.cluster >= 0 && (
        <NameField
          title={`Name of cluster ${segment.cluster}, of ${describeMembers(session, segment.cluster)}`}
          placeholder="no name"
          value={called}
          naming="cluster"
          onName={(label) => editor.edit({ kind: "name_cluster", cluster: segment.cluster, label })}
        />
      )}
      <Comment segment={segment} table={table} />
      <SharedLabels />
    </div>
  );
}

function ClusterSelect({ segment }: { segment: Segment }) {
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
  /** Which name this field edits; the editor can focus it. */
  naming: "segment" | "cluster";
  onName: (label: string) => void;
}

function NameField({ title, placeholder, value, naming, onName }: NameProps) {
  const { session, editor } = useStudio();
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
    <Field title={title}>
      <NameInput {...{ field, value, placeholder, list, onName }} />
      <datalist id={list}>
        {listNames(session).map((name) => (
          <option key={name} value={name} />
        ))}
      </datalist>
    </Field>
  );
}

function listNames(session: Session): string[] {
  const rows = session.store.table.value?.segments ?? [];
  return [...new Set(rows.map((row) => row.label))].filter(Boolean).sort();
}

/** Edit the comment on a segment of a table. */
function Comment({ segment, table }: { segment: Segment; table: Segments | undefined }) {
  const { editor } = useStudio();
  const draft = useDraft(segment.comment ?? "", (now) =>
    editor.edit({ kind: "comment", ...getTarget(segment), text: now.trim() }, table),
  );
  return (
    <Field title="Comment">
      <textarea rows={2} placeholder="what others should know of it" {...draft} />
    </Field>
  );
}

const KEYS = 9;

/** Edit the labels that all recordings share; the first nine have the keys 1 to 9. */
function SharedLabels() {
  const { session, editor } = useStudio();
  const labels = session.state.value?.labels ?? [];
  const name = useSignal("");
  const saveLabels = (next: string[]): Promise<boolean> =>
    session.notifications.attempt("labels", async () => {
      await session.api.shareLabels({ labels: next });
      await session.refresh();
    });
  return (
    <section class="vocabulary" aria-label="Shared labels">
      <h2>Labels of the folder</h2>
      <div class="choices">
        {labels.map((label, i) => (
          <span class="group" key={label}>
            <Button
              title={
                i < KEYS ? `Name the segment “${label}” (${i + 1})` : `Name the segment “${label}”`
              }
              onClick={() => editor.nameTarget(label)}
            >
              {i < KEYS && <kbd>{i + 1}</kbd>} {label}
            </Button>
            <CloseButton
              label={`Take “${label}” off the list`}
              onClick={() => void saveLabels(labels.filter((each) => each !== label))}
            />
          </span>
        ))}
      </div>
      <Form
        onSubmit={() => {
          const label = name.value.trim();
          name.value = "";
          if (label) void saveLabels([...labels, label]);
        }}
      >
        <TextInput
          aria-label="A label for all recordings of the folder"
          placeholder={labels.length ? "one more label" : "a label for the key 1"}
          value={name}
          onKeyDown={(event) => event.key === "Escape" && event.currentTarget.blur()}
        />
        <Button type="submit">Add</Button>
      </Form>
    </section>
  );
}

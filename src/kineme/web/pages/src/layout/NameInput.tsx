/** Edit a name; Enter or leaving the field saves it, Escape restores it. */
import type { JSX, Ref } from "preact";
import { useDraft } from "./useDraft";

interface Props {
  value: string;
  placeholder?: string;
  label?: string;
  /** Id of a datalist with suggestions. */
  list?: string;
  field?: Ref<HTMLInputElement>;
  onName: (name: string) => void;
  onDone?: () => void;
}

export function NameInput({
  value,
  placeholder = "no name",
  label,
  list,
  field,
  onName,
  onDone,
}: Props): JSX.Element {
  const draft = useDraft(value, (text) => text.trim() !== value && onName(text.trim()));
  return (
    <input
      ref={field ?? null}
      type="text"
      placeholder={placeholder}
      aria-label={label}
      list={list}
      {...draft}
      onBlur={() => {
        draft.onBlur();
        onDone?.();
      }}
    />
  );
}

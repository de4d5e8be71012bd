/** Keep the text typed into a field while the page around it changes. */
import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { TargetedEvent, TargetedKeyboardEvent } from "preact";

type Field = HTMLInputElement | HTMLTextAreaElement;

interface DraftProps {
  value: string;
  onFocus: (event: TargetedEvent<Field>) => void;
  onInput: (event: TargetedEvent<Field>) => void;
  onChange: () => void;
  onBlur: () => void;
  onKeyDown: (event: TargetedKeyboardEvent<Field>) => void;
}

/**
 * Return the properties of a field that shows its draft while focused and `value` otherwise. Each
 * change calls the `onText` that was current when the field got the focus: meanwhile playback or an
 * edit may have put another segment into the panel. Escape discards the draft.
 */
export function useDraft(value: string, onText: (text: string) => void): DraftProps {
  const draft = useSignal<string | null>(null);
  const initial = useRef({ value, onText });
  const commit = (): void => {
    const text = draft.value;
    if (text === null || text === initial.current.value) return;
    initial.current.value = text;
    initial.current.onText(text);
  };
  return {
    value: draft.value ?? value,
    onFocus: (event) => {
      initial.current = { value, onText };
      draft.value = event.currentTarget.value;
    },
    onInput: (event) => (draft.value = event.currentTarget.value),
    onChange: commit,
    onBlur: () => {
      commit();
      draft.value = null;
    },
    onKeyDown: (event) => {
      const isTextArea = event.currentTarget instanceof HTMLTextAreaElement;
      if (event.key === "Escape") draft.value = null;
      if (event.key === "Escape" || (event.key === "Enter" && (!isTextArea || event.ctrlKey)))
        event.currentTarget.blur();
    },
  };
}

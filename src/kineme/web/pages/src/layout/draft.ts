/** What is typed into a field, kept while the page around it changes. */
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
 * Properties of a field that shows its draft while it has the focus, and `value` otherwise.
 *
 * Each change (a step of a number, Enter, leaving the field) hands the draft to the `onText` of when
 * the field got the focus: meanwhile playback or another edit may have put another segment in the
 * panel. Escape drops the draft.
 */
export function useDraft(value: string, onText: (text: string) => void): DraftProps {
  const draft = useSignal<string | null>(null);
  const begun = useRef({ value, onText });
  const commit = (): void => {
    const text = draft.value;
    if (text === null || text === begun.current.value) return;
    begun.current.value = text;
    begun.current.onText(text);
  };
  return {
    value: draft.value ?? value,
    onFocus: (event) => {
      begun.current = { value, onText };
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

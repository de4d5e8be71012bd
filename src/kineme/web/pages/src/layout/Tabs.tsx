/** Show one of several panels; arrow keys switch between tabs. */
import { useSignal, type Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { isPlayerKey } from "../keys";
import { Button } from "./controls";

export interface Tab {
  id: string;
  title: string;
  panel: () => ComponentChildren;
}

interface Props {
  label: string;
  tabs: readonly Tab[];
  /** Id of the open tab; the first tab by default. */
  open?: Signal<string>;
}

export function Tabs({ label, tabs, open }: Props) {
  const chosen = useSignal(tabs[0]?.id ?? "");
  const shown = open ?? chosen;
  const tab = tabs.find((each) => each.id === shown.value) ?? tabs[0];
  const onKeyDown = (event: KeyboardEvent): void => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by || !tab || isPlayerKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
    const next = tabs[(tabs.indexOf(tab) + by + tabs.length) % tabs.length]!;
    shown.value = next.id;
    document.getElementById(`tab-${next.id}`)?.focus();
  };
  return (
    <div class="tabs">
      <div class="tab-row" role="tablist" aria-label={label} onKeyDown={onKeyDown}>
        {tabs.map((each) => (
          <Button
            key={each.id}
            id={`tab-${each.id}`}
            role="tab"
            aria-selected={each === tab}
            aria-controls={`panel-${each.id}`}
            tabIndex={each === tab ? 0 : -1}
            onClick={(event) => {
              shown.value = each.id;
              scrollToPanel(event.currentTarget);
            }}
          >
            {each.title}
          </Button>
        ))}
      </div>
      {tab && (
        <div
          class="tab-panel"
          id={`panel-${tab.id}`}
          role="tabpanel"
          aria-labelledby={`tab-${tab.id}`}
          tabIndex={0}
        >
          {tab.panel()}
        </div>
      )}
    </div>
  );
}

/** On scrolling pages, scroll the opened panel to the top of the window. */
function scrollToPanel(tab: Element): void {
  if (document.documentElement.scrollHeight > innerHeight)
    tab.closest(".tabs")?.scrollIntoView({ block: "start" });
}

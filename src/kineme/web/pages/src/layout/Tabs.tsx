/** Several panels in one place, one shown at a time; arrow keys go from tab to tab. */
import { useSignal, type Signal } from "@preact/signals";
import type { ComponentChildren, JSX } from "preact";
import { isForPlayer } from "../focus";
import { Button } from "./controls";

export interface Tab {
  id: string;
  title: string;
  panel: () => ComponentChildren;
}

interface Props {
  label: string;
  tabs: readonly Tab[];
  /** Which tab is open; the first where not given. */
  open?: Signal<string>;
}

export function Tabs({ label, tabs, open }: Props): JSX.Element {
  const chosen = useSignal(tabs[0]?.id ?? "");
  const shown = open ?? chosen;
  const tab = tabs.find((each) => each.id === shown.value) ?? tabs[0];
  const onKeyDown = (event: KeyboardEvent): void => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by || !tab || isForPlayer(event)) return;
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
              bringUp(event.currentTarget);
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

/** Where the page itself scrolls, a panel that is asked for gets the height of the window. */
function bringUp(tab: Element): void {
  if (document.documentElement.scrollHeight > innerHeight)
    tab.closest(".tabs")?.scrollIntoView({ block: "start" });
}

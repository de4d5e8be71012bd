/** Choose the dark or light theme: the system's, until the user changes it. */
import { computed, effect, signal } from "@preact/signals";

export type Theme = "dark" | "light";

const media = matchMedia("(prefers-color-scheme: dark)");
const system = signal<Theme>(media.matches ? "dark" : "light");
const chosen = signal<Theme | null>(null);
/** Whether the page is being printed. */
export const isPrinting = signal(false);

media.addEventListener("change", () => (system.value = media.matches ? "dark" : "light"));

export const theme = computed<Theme>(() =>
  isPrinting.value ? "light" : (chosen.value ?? system.value),
);

// Canvases read the CSS variables right after this, so it must not wait for a frame.
effect(() => document.documentElement.setAttribute("data-theme", theme.value));

export function toggleTheme(): void {
  chosen.value = theme.value === "dark" ? "light" : "dark";
}

/** Return a colour of the theme's style sheet as `#rrggbb` or `rgba(…)`. */
export function readColor(name: string): string {
  const key = `${theme.value} ${name}`; // makes callers depend on the theme
  let color = colors.get(key);
  if (color === undefined) {
    const style = getComputedStyle(document.documentElement);
    pen.fillStyle = style.getPropertyValue(`--${name}`).trim();
    color = String(pen.fillStyle); // normalised by the canvas
    colors.set(key, color);
  }
  return color;
}

const colors = new Map<string, string>();
const pen = new OffscreenCanvas(1, 1).getContext("2d")!;

/** What of the page cannot be seen or used: cut off, covered, outside of the window, too small. */
() => {
  const LEAST = 23.9; // pixels of a target: 24, but for what is lost in zooming
  const faults = [];
  const page = document.documentElement;
  const name = (element) =>
    (element.ariaLabel || element.textContent || element.className).trim().slice(0, 40);
  const shown = (element) => {
    const { width, height } = element.getBoundingClientRect();
    return width > 0 && height > 0 && !element.closest(".unseen, [inert]") && element.checkVisibility();
  };
  /** Whether a scrolling or clipping box around it keeps it from being seen as a whole. */
  const clippedBy = (element) => {
    const box = element.getBoundingClientRect();
    for (let at = element.parentElement; at && at !== document.body; at = at.parentElement) {
      const { overflowX, overflowY } = getComputedStyle(at);
      if (overflowX === "visible" && overflowY === "visible") continue;
      const room = at.getBoundingClientRect();
      if (box.left < room.left - 1 || box.right > room.right + 1) return [at, overflowX, "wide"];
      if (box.top < room.top - 1 || box.bottom > room.bottom + 1) return [at, overflowY, "high"];
    }
    return null;
  };
  const check = (control) => {
    const { width, height } = control.getBoundingClientRect();
    if (control.localName === "button" && Math.min(width, height) < LEAST)
      faults.push(`“${name(control)}” is ${width.toFixed()} × ${height.toFixed()}`);
    const clip = clippedBy(control);
    if (clip) {
      const [at, overflow, what] = clip;
      if (what === "wide" || !["auto", "scroll"].includes(overflow))
        faults.push(`“${name(control)}” is cut off by ${at.className}`);
      return;
    }
    const { left, right, top, bottom } = control.getBoundingClientRect();
    if (left < -1 || right > innerWidth + 1) faults.push(`“${name(control)}” is outside`);
    const [x, y] = [(left + right) / 2, (top + bottom) / 2];
    if (y < 0 || y > innerHeight) {
      if (page.scrollHeight <= innerHeight) faults.push(`“${name(control)}” is out of reach`);
      return;
    }
    const over = document.elementFromPoint(x, y);
    const own = over && (control.contains(over) || over.contains(control));
    if (!own && !over?.closest("label")?.contains(control))
      faults.push(`“${name(control)}” is covered by “${over && name(over)}”`);
  };
  if (page.scrollWidth > innerWidth) faults.push(`the page is ${page.scrollWidth} pixels wide`);
  const front = document.querySelector("dialog[open]") ?? document;
  [...front.querySelectorAll("button, input, select, summary")].filter(shown).forEach(check);
  for (const canvas of document.querySelectorAll("canvas")) {
    const { width, height } = canvas.getBoundingClientRect();
    if (width < 150 || height < 10) faults.push(`a canvas has ${width} × ${height} pixels`);
  }
  return faults;
};

/** Show the names of several people above their heads. */

/** A name and its position (bottom centre), as shares of the canvas. */
export interface Tag {
  name: string;
  x: number;
  y: number;
  /** Whether edits apply to this person. */
  isActive: boolean;
}

export class NameTags {
  private readonly place = document.createElement("div");

  constructor(over: HTMLElement) {
    this.place.className = "name-tags";
    this.place.ariaHidden = "true"; // the caption also has them
    over.append(this.place);
  }

  show(tags: readonly Tag[]): void {
    const { place } = this;
    while (place.children.length > tags.length) place.lastChild!.remove();
    while (place.children.length < tags.length) place.append(document.createElement("span"));
    tags.forEach(({ name, x, y, isActive }, i) => {
      const tag = place.children[i] as HTMLElement;
      if (tag.textContent !== name) tag.textContent = name;
      tag.classList.toggle("front", isActive);
      tag.style.left = `${100 * x}%`;
      tag.style.top = `${100 * y}%`;
    });
  }

  dispose(): void {
    this.place.remove();
  }
}

/** Who is who of several people in the picture: their names, over their heads. */

/** A name, and the middle of its lower edge: shares of the picture's width and height. */
export interface Tag {
  name: string;
  x: number;
  y: number;
  /** Whether edits go to this person. */
  front: boolean;
}

export class NameTags {
  private readonly place = document.createElement("div");

  constructor(over: HTMLElement) {
    this.place.className = "name-tags";
    this.place.ariaHidden = "true"; // the caption has them, too
    over.append(this.place);
  }

  show(tags: readonly Tag[]): void {
    const { place } = this;
    while (place.children.length > tags.length) place.lastChild!.remove();
    while (place.children.length < tags.length) place.append(document.createElement("span"));
    tags.forEach(({ name, x, y, front }, i) => {
      const tag = place.children[i] as HTMLElement;
      if (tag.textContent !== name) tag.textContent = name;
      tag.classList.toggle("front", front);
      tag.style.left = `${100 * x}%`;
      tag.style.top = `${100 * y}%`;
    });
  }

  dispose(): void {
    this.place.remove();
  }
}

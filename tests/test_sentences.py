"""README and docs are read once, by strangers: nine of ten sentences have thirty words at most."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MADE = ("results", "changes", "parameters")
"""Pages made from a template, the changelog, or the help of constants."""
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
LONGEST, ONE_IN = 30, 10

ASIDE = re.compile(r"^(```|~~~).*?^\1|<!--.*?-->|^---\n.*?^---$", re.DOTALL | re.MULTILINE)
NO_PROSE = re.compile(r"^\s*(\||#|!\[|<|:::|!!!|\?\?\?|    \S|\[\w+\]: )")
LINK = re.compile(r"!?\[([^\]]*)\](\([^)]*\)|\[[^\]]*\])")
ITEM = re.compile(r"^\s*([-*+>]|\d+\.)\s+")
END = re.compile(r"(?<=[.!?])[)*_”]*\s+(?=[\W\d]*[A-Z`])")


def sentences(page: str) -> Iterator[str]:
    """What is prose on a page, sentence by sentence: no code, tables, headings or pictures."""
    paragraph: list[str] = []
    for line in [*ASIDE.sub("", page).splitlines(), ""]:
        if not line.strip() or NO_PROSE.match(line) or ITEM.match(line):
            yield from END.split(" ".join(paragraph))
            paragraph = [] if not ITEM.match(line) else [ITEM.sub("", line)]
        else:
            paragraph.append(line.strip())


def words(sentence: str) -> int:
    return len(re.findall(r"\S*\w\S*", LINK.sub(r"\1", sentence)))


def long_ones(page: str) -> tuple[list[str], int]:
    """Sentences of more than `LONGEST` words, and how many sentences there are."""
    counted = [(words(sentence), sentence) for sentence in sentences(page)]
    counted = [(number, sentence) for number, sentence in counted if number]
    return [f"{n} words: {sentence}" for n, sentence in counted if n > LONGEST], len(counted)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.stem not in MADE], ids=lambda page: page.stem
)
def test_sentences_are_short(page: Path) -> None:
    found, number = long_ones(page.read_text(encoding="utf-8"))
    assert len(found) * ONE_IN <= number, "\n".join(found)


def test_only_prose_is_counted_sentence_by_sentence() -> None:
    page = """# A heading

One sentence, of [four](page.md#and-more) words. A second (e.g. this one).
It goes on.

- `kineme info` tells it.
  And more.

| a | table |
|---|---|
| of | 1 |

```sh
kineme segment take.bvh
```
"""
    told = [s for s in sentences(page) if s]
    assert [words(s) for s in told] == [5, 5, 3, 4, 2]
    assert long_ones("word " * 31 + "end. Short.") == ([f"32 words: {'word ' * 31}end."], 2)

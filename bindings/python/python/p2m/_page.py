"""Pages in notebooks, in files and in the browser."""

from __future__ import annotations

import html
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from . import _p2m
from ._arrays import check_choice

if TYPE_CHECKING:
    from ._index import Index
    from ._scene import Scene

# The largest number of primitives for which a page answers queries at the pointer.
_MAX_LIVE = 100_000
# The size of a field relative to the box of its scene.
_FIELD_SCALE = 1.2


class Page:
    """A page that shows a scene, a field or deviations. Notebooks show it, and any browser opens it without a network.

    `Scene.show`, `Index.show` and `Deviation.show` return it.
    """

    __slots__ = ("html",)

    html: str
    """The page as HTML, in one piece."""

    def __init__(self, text: str) -> None:
        self.html = text

    def __repr__(self) -> str:
        return f"Page(bytes={len(self.html.encode())})"

    def _repr_html_(self) -> str:
        # The page is a separate document, so that its style and script do not affect the notebook.
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" style="width: 100%; height: 600px; border: 0" '
            'sandbox="allow-scripts allow-downloads" title="p2m"></iframe>'
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        _p2m.write_bytes(Path(path), self.html.encode())

    def open(self) -> None:
        """Open the page in the browser. The page is written to a folder for temporary files, and stays there."""
        with tempfile.NamedTemporaryFile("w", suffix=".html", prefix="p2m-", encoding="utf-8", delete=False) as file:
            file.write(self.html)
        webbrowser.open(Path(file.name).as_uri())


def checked_up(up: str) -> bool:
    """Return whether y points up, and raise an error for another axis than y and z."""
    check_choice(up, "up", ("y", "z"))
    return up == "y"


def scene_page(
    scene: Scene,
    index: Index | None,
    *,
    field: int | None,
    sign: Literal["auto", "winding", "parity"] | None,
    unit: str,
    up: str,
) -> Page:
    """Return the page of a scene. If `field` is given, the index computes a distance field of this resolution."""
    is_y_up = checked_up(up)
    kinds = scene.counts._asdict().items()
    words = [f"{number:,} {kind}" for kind, number in kinds if number > 0 and kind != "vertices"]
    values = None
    if field is not None and index is not None:
        if field < 2:
            raise ValueError(f"field: {field} is less than 2 points")
        origin, spacing, shape = grid = _p2m.grid_around(scene._raw, field, _FIELD_SCALE)
        signs: dict[str, Any] = {} if sign is None else {"signed": True, "sign": sign}
        distances = index.field(origin, spacing, shape, **signs)
        values = (grid, distances.ravel(order="F"))
    texts = ("Scene", ", ".join(words) or "an empty scene", unit)
    return Page(_p2m.scene_page(scene._raw, texts, is_y_up, len(scene) <= _MAX_LIVE, values))

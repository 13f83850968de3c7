"""Pages of scenes, fields and deviations, which notebooks show."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Any

import pytest

import p2m

SOLID = p2m.Scene(
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], triangles=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
)


def data(page: p2m.Page) -> Any:
    """Return the data of a page."""
    found = re.search(r'id="data">(.*?)</script>', page.html, re.S)
    assert found is not None
    return json.loads(found[1])


def test_a_scene_has_a_page_that_answers_queries() -> None:
    page = SOLID.show(unit="mm", up="y")
    found = data(page)
    assert (found["unit"], found["up"]) == ("mm", "y")
    assert "live" in found and "field" not in found
    assert "4 triangles" in page.html


def test_a_field_has_the_points_of_its_grid_and_signs_if_asked_for() -> None:
    index = p2m.Index(SOLID)
    found = data(index.show(field=9, sign="winding"))["field"]
    assert max(found["counts"]) == 9
    assert found["values"] != data(index.show(field=9))["field"]["values"]
    with pytest.raises(ValueError, match="less than 2"):
        index.show(field=1)
    with pytest.raises(ValueError, match="up: 'x'"):
        index.show(up="x")  # type: ignore[arg-type]


def test_notebooks_show_the_page_in_a_frame(tmp_path: Path) -> None:
    found = p2m.deviation([[0.1, 0.1, 0.1], [2, 2, 2]], SOLID, tolerance=0.5)
    page = found.show()
    frame = page._repr_html_()
    inner = re.fullmatch(
        r'<iframe srcdoc="(.*?)" style=.*sandbox="allow-scripts allow-downloads".*</iframe>', frame, re.S
    )
    assert inner is not None and html.unescape(inner[1]) == page.html
    assert '"' not in inner[1]
    # The saved file is the same page, whose colours end at three tolerances.
    found.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.html
    assert data(page)["deviations"]["limit"] == found.limit == 1.5


def test_a_page_opens_in_the_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    page = SOLID.show()
    page.open()
    path = Path(opened[0].removeprefix("file://"))
    assert path.read_text(encoding="utf-8") == page.html
    path.unlink()

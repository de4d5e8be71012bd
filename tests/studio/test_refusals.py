"""Requests that the studio must refuse, and that leave no trace outside its folder, or in it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from studio_clients import PORT, TOKEN

from kineme.errors import ParameterError
from kineme.studio.http.bodies import MAX_NAME, make_safe_name
from kineme.studio.http.security import DEVELOPMENT, HEADERS
from kineme.web.encoding import from_json, to_json
from kineme.web.requests import EditRequest

API = ("/api/state", "/api/recordings/x", "/api/recordings/x/motion", "/api/events", "/api/none")


def everything(place: Path) -> dict[str, bytes]:
    """All files around the folder, and what they hold."""
    found = sorted(path for path in place.parent.rglob("*") if path.is_file())
    return {str(path.relative_to(place.parent)): path.read_bytes() for path in found}


@pytest.fixture(autouse=True)
def _nothing_else_is_touched(folder: Path) -> Iterator[None]:
    """Whatever a test of this page sends, what is outside the folder stays as it was."""
    outside = {name: data for name, data in everything(folder).items() if "folder/" not in name}
    yield
    assert outside == {n: data for n, data in everything(folder).items() if "folder/" not in n}


@pytest.mark.parametrize("token", [None, "", "wrong", TOKEN[:-1], TOKEN + "x", "tökén"])
def test_nothing_is_told_without_the_token(studio, token) -> None:
    headers = {} if token is None else {"x-kineme-token": token.encode()}
    studio.client.headers.pop("x-kineme-token")
    for address in (
        *API,
        f"/api/state?token={TOKEN}",
        f"/api/recordings/{studio.id}?token={TOKEN}",
    ):
        answer = studio.get(address, headers=headers)
        assert answer.status_code == 403, address
        assert "token" in answer.json()["error"]
    sent = studio.client.post("/api/recordings?name=a.bvh", content=b"HIERARCHY", headers=headers)
    assert sent.status_code == 403
    edit = {"revision": 1, "edit": {"kind": "undo"}}
    answer = studio.post(f"{studio.one}/edits", edit, headers=headers)
    assert answer.status_code == 403
    assert [path.name for path in studio.folder.iterdir()] == ["take.bvh"]


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8750", "127.0.0.1", "127.0.0.1:80", "localhost:8751",
     "127.0.0.1:8750.evil.example", "127.0.0.1:8750@evil.example", "[::1]:8750", ""],
)  # fmt: skip
def test_no_other_host_is_answered_for(studio, host) -> None:
    for address in ("/", "/api/state", "/assets/studio.css"):
        assert studio.get(address, headers={"host": host}).status_code == 403


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:1"},
        {"origin": f"https://127.0.0.1:{PORT}"},
        {"origin": f"http://127.0.0.1:{PORT}.evil.example"},
        {"sec-fetch-site": "cross-site"},
    ],
)
def test_pages_of_other_origins_are_refused(studio, headers) -> None:
    assert studio.get("/api/state", headers=headers).status_code == 403
    answer = studio.client.post("/api/recordings?name=a.bvh", content=b"x", headers=headers)
    assert answer.status_code == 403


def test_its_own_page_is_not(studio) -> None:
    for host in (f"127.0.0.1:{PORT}", f"localhost:{PORT}"):
        own = {"host": host, "origin": f"http://{host}", "sec-fetch-site": "same-origin"}
        assert studio.get("/api/state", headers=own).status_code == 200


def test_the_development_server_asks_where_it_is_allowed_to(make_studio) -> None:
    headers = {"origin": DEVELOPMENT, "sec-fetch-site": "same-origin"}
    for allowed in (True, False):
        studio = make_studio(development=allowed)
        assert studio.get("/api/state", headers=headers).status_code == (200 if allowed else 403)
        studio.client.headers.pop("x-kineme-token")
        assert studio.get("/api/state", headers=headers).status_code == 403


def test_every_answer_carries_the_headers_that_keep_it_here(studio) -> None:
    for address in ("/", "/none", "/api/state", "/api/none", studio.one):
        for headers in ({}, {"host": "evil.example"}):
            answer = studio.get(address, headers=headers)
            assert HEADERS.items() <= dict(answer.headers).items()
            assert answer.headers["cache-control"] in ("no-store", "no-cache")
            assert "access-control-allow-origin" not in answer.headers
    policy = studio.get("/").headers["content-security-policy"]
    assert policy.startswith("default-src 'none'; script-src 'self';")
    assert "unsafe" not in policy


@pytest.mark.parametrize(
    "path",
    ["../secret.bvh", "..%2fsecret.bvh", "%2e%2e/secret.bvh", "..\\secret.bvh", "/etc/passwd",
     "take.bvh", "..", ".", "", "%00", "take.bvh%00.x", "C:%5csecret.bvh", "a" * 5000],
)  # fmt: skip
def test_ids_and_addresses_name_no_files(studio, path) -> None:
    for address in (
        f"/api/recordings/{path}",
        f"/api/recordings/{path}/motion",
        f"/api/recordings/{path}/export/json",
        f"/assets/{path}",
        f"/{path}",
    ):
        answer = studio.get(address)
        if answer.status_code == 200:  # the page itself: what is left of "/." and "/"
            assert answer.headers["content-type"].startswith("text/html")
        else:
            assert answer.status_code in (400, 404, 405), address  # 400: what is left of ".."
        assert b"secret" not in answer.content
        assert b"root:" not in answer.content
    sent = {"annotation": path}
    compare = studio.post(f"{studio.one}/compare", sent)
    assert compare.status_code in (400, 404)
    assert "secret.bvh:" not in compare.text


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("../../new.bvh", "new.bvh"),
        ("..\\..\\new.bvh", "new.bvh"),
        ("/etc/new.bvh", "new.bvh"),
        ("C:\\new.bvh", "new.bvh"),
        ("...new.bvh", "new.bvh"),
        (".bashrc.bvh", "bashrc.bvh"),
        ("CON.bvh", "_CON.bvh"),
        ("a\0b\n\u202e.bvh", "a_b__.bvh"),
        ("<img src=x onerror=alert(1)>.bvh", "_img src=x onerror=alert(1)_.bvh"),
        ("Gänge 3.bvh", "Gänge 3.bvh"),
        ("a" * 999 + ".bvh", "a" * (MAX_NAME - 4) + ".bvh"),
    ],
)
def test_an_upload_gets_a_name_of_our_own_making(studio, name, kept) -> None:
    answer = studio.client.post("/api/recordings", params={"name": name}, content=b"HIERARCHY")
    assert (answer.status_code, answer.json()["name"]) == (200, kept)
    assert {path.name for path in studio.folder.iterdir()} == {"take.bvh", kept}


@pytest.mark.parametrize(
    "name", ["", "..", ".bvh", "a.sh", "a.html", "a.bvh.exe", "a.segments.js", "../", "a.bvh/.."]
)
def test_an_upload_that_is_no_recording_is_refused(studio, name) -> None:
    answer = studio.client.post("/api/recordings", params={"name": name}, content=b"#!/bin/sh")
    assert answer.status_code == 400
    assert "suffix" in answer.json()["error"]
    assert [path.name for path in studio.folder.iterdir()] == ["take.bvh"]


@given(st.text(max_size=300))
def test_names_stay_in_the_folder_and_fit_on_any_disk(name: str) -> None:
    safe = make_safe_name(name)
    assert not set(safe) & set('/\\<>:"|?*\0')
    assert not safe.startswith(".")
    assert len(safe.encode(errors="replace")) <= MAX_NAME + 1
    assert make_safe_name(safe) == safe


def test_an_upload_never_takes_the_place_of_a_file(studio) -> None:
    before = studio.path.read_bytes()
    other = studio.client.post("/api/recordings?name=take.bvh", content=b"HIERARCHY other")
    assert other.json()["name"] == "take_2.bvh"
    assert studio.path.read_bytes() == before
    again = studio.client.post("/api/recordings?name=take.bvh", content=before)
    assert again.json()["id"] == studio.id  # the same bytes: the file that is there
    assert {path.name for path in studio.folder.iterdir()} == {"take.bvh", "take_2.bvh"}


def test_an_upload_that_claims_two_gigabytes_is_refused_before_it_is_read(studio) -> None:
    def never() -> Iterator[bytes]:
        yield b"x"
        raise AssertionError("read on")

    headers = {"content-length": str(2 * 10**9)}
    address = "/api/recordings?name=big.bvh"
    answer = studio.client.post(address, content=never(), headers=headers)
    assert answer.status_code == 413
    assert "2000000000 bytes" in answer.json()["error"]
    assert [path.name for path in studio.folder.iterdir()] == ["take.bvh"]


def test_an_upload_that_overruns_is_cut_off_and_taken_away(make_studio) -> None:
    studio = make_studio(limit=100_000)
    chunks = (b"x" * 10_000 for _ in range(20))  # no length is announced
    answer = studio.client.post("/api/recordings?name=big.bvh", content=chunks)
    assert answer.status_code == 413
    assert [path.name for path in studio.folder.iterdir()] == ["take.bvh"]


EDITS = [
    b"{}",
    b"null",
    b'{"kind": ["undo"]}',
    b'{"kind": "format_disk"}',
    b'{"kind": "undo", "more": 1}',
    b'{"kind": "split", "level": "activity"}',
    b'{"kind": "split", "level": "floor", "frame": 3}',
    b'{"kind": "split", "level": ["activity"], "frame": 3}',
    b'{"kind": "split", "level": "activity", "frame": 3.5}',
    b'{"kind": "split", "level": "activity", "frame": NaN}',
    b'{"kind": "split", "level": "activity", "frame": 1%s}' % (b"0" * 30),
    b'{"kind": "split", "level": "activity", "frame": 1%s}' % (b"0" * 5000),
    b'{"kind": "name_cluster", "cluster": 0, "label": 5}',
    b'{"kind": "name_cluster", "cluster": 0, "label": "%s"}' % (b"a" * 999),
    b'{"kind": "segment", "preset": "kineme", "parameters": [1]}',
    b'{"kind": "segment", "preset": "kineme", "parameters": {"x": 1}}',
    b'{"kind": "segment", "preset": "kineme", "parameters": {"averaging": "1"}}',
    b'{"kind": "segment", "preset": "kineme", "parameters": {"averaging": 1e999}}',
    b'{"kind": "transfer", "knowledge_base": "x", "threshold": null}',
]
BODIES = [
    *(b"", b"{", b"nonsense", b"null", b"[]", b"1", b'"a"', b"\xff\xfe", b"[" * 100_000),
    *(b'{"revision": 1, "edit": %s}' % edit for edit in EDITS),
    b'{"revision": 1}',
    b'{"revision": 1, "edit": {"kind": "undo"}, "more": 1}',
    b'{"revision": "1", "edit": {"kind": "undo"}}',
    b'{"revision": true, "edit": {"kind": "undo"}}',
    b'{"revision": 1.0, "edit": {"kind": "undo"}}',
]


def test_what_is_no_edit_is_refused(studio) -> None:
    address = studio.one
    for body in BODIES:
        answer = studio.client.post(f"{address}/edits", content=body)
        assert answer.status_code in (400, 404), body
        assert answer.json()["error"], body
        assert not studio.table.exists(), body
        assert studio.client.post(f"{address}/compare", content=body).status_code == 400, body


def test_a_request_of_many_megabytes_is_refused(studio) -> None:
    chunks = (b"a" * 100_000 for _ in range(1000))
    assert studio.client.post(f"{studio.one}/edits", content=chunks).status_code == 413


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=9), inner),
    max_leaves=9,
)
KINDS = st.sampled_from(["split", "merge", "segment", "transfer", "name_cluster", "undo", "x"])


@settings(max_examples=60)
@given(st.fixed_dictionaries({"kind": KINDS | JSON, "level": JSON, "frame": JSON}) | JSON, JSON)
def test_any_value_is_a_message_or_a_sentence(edit: object, revision: object) -> None:
    value = {"revision": revision, "edit": edit}
    try:
        message = from_json(json.dumps(value).encode(), EditRequest)
        assert json.loads(to_json(message)) == value
    except ParameterError as error:
        assert str(error)


@given(st.binary(max_size=60))
def test_any_bytes_are_a_message_or_a_sentence(body: bytes) -> None:
    with pytest.raises(ParameterError) as caught:
        from_json(body, EditRequest)
    assert str(caught.value)


def test_names_with_html_in_them_stay_data(studio) -> None:
    label = '"><script>alert(1)</script>'
    named = studio.apply("name_segment", level="activity", frame=0, label=label)
    assert named["segmentation"]["segments"][0]["label"] == label
    for address in (studio.one, f"{studio.one}/export/json"):
        answer = studio.get(address)
        assert answer.headers["content-type"] in ("application/json", "application/octet-stream")
        assert answer.headers["x-content-type-options"] == "nosniff"
    assert b"script>" not in studio.get("/").content.replace(b"</script>", b"")


def test_a_table_that_is_a_link_is_not_followed(studio, folder: Path) -> None:
    target = folder.parent / "target.json"
    target.write_text("mine")
    studio.table.symlink_to(target)
    saved = studio.apply("split", level="activity", frame=50)
    assert saved["saved"] == "take.bvh.segments.json"
    (folder / "take.bvh.segments.json").unlink()
    (folder / "take.bvh.segments.json").symlink_to(target)
    assert studio.edit(saved["revision"], "undo").status_code in (409, 500)
    assert target.read_text() == "mine"
    target.unlink()


def test_nothing_in_a_folder_that_may_not_be_written_to_is_lost(studio, monkeypatch) -> None:
    before = studio.recording()

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    answer = studio.edit(1, "split", level="activity", frame=50)
    assert answer.status_code == 500
    assert "No space left" in answer.json()["error"]
    assert studio.recording() == before
    assert [path.name for path in studio.folder.iterdir()] == ["take.bvh"]


def test_files_of_the_page_are_asked_for_anew_each_time(make_studio, tmp_path_factory) -> None:
    static = tmp_path_factory.mktemp("static")
    (static / "assets").mkdir()
    (static / "studio.html").write_text("<title>studio</title>")
    (static / "assets" / "studio.js").write_text("1;")
    (static / "notes.txt").write_text("no part of the page")
    (static / "assets" / "secret.js").symlink_to(static / "notes.txt")
    studio = make_studio(static=static)
    page = studio.get("/?token=x", headers={"x-kineme-token": ""})
    assert (page.status_code, page.text) == (200, "<title>studio</title>")
    script = studio.get("/assets/studio.js")
    assert script.headers["content-type"] == "text/javascript; charset=utf-8"
    assert script.headers["cache-control"] == "no-cache"
    again = studio.get("/assets/studio.js", headers={"if-none-match": script.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    for address in ("/notes.txt", "/assets/../notes.txt", "/assets/secret.js", "/assets/"):
        assert studio.get(address).status_code == 404
    bare = make_studio(static=static / "none")
    assert bare.get("/").status_code == 404
    assert "npm run build" in bare.get("/").text

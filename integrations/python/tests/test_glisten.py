"""The Python package: what it returns, what it raises, and that threads and notebooks may use it."""

import copy
import errno
import json
import pathlib
import pickle
import runpy
import subprocess
import sys
import threading

import pytest

import glisten

np = pytest.importorskip("numpy", reason="pictures are NumPy arrays")

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLE = HERE.parent / "examples" / "explore.py"
VERTEX = "#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n"
FRAGMENT = "#version 150\nuniform vec4 tint;\nout vec4 c;\nvoid main() { c = tint * LEVEL; }\n"
PROGRAM = {"a.vert": VERTEX, "a.frag": FRAGMENT}


def test_code_and_reflection():
    program = glisten.compile(PROGRAM, defines={"LEVEL": 0.5}, attributes={"p": 3}, glsl_version="450")
    assert program.stages == ["vertex", "fragment"]
    assert "@vertex" in program.wgsl("vertex") and "#version 450" in program.glsl("fragment")
    assert program.spirv("vertex")[:4] == b"\x03\x02\x23\x07"
    assert program.msl("fragment") and program.hlsl("fragment")
    assert program.reflection["attributes"][0]["location"] == 3
    assert [row["name"] for row in program.reflection["uniforms"]] == ["tint"]
    assert program.diagnostics == []


def test_an_engine_and_preludes_complete_sources():
    material = {"a.vert": "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }"}
    assert "@vertex" in glisten.compile(material, engine="three").wgsl("vertex")
    with pytest.raises(glisten.CompileError):
        glisten.compile(material)
    bare = {"a.frag": "void main() { c = vec4(k); }"}
    program = glisten.compile(bare, assume_version="150", prelude=["uniform float k;", "out vec4 c;"])
    assert [row["name"] for row in program.reflection["uniforms"]] == ["k"]
    with pytest.raises(ValueError, match="did you mean `three`"):
        glisten.compile(material, engine="tree")


def test_files(tmp_path):
    for name, text in PROGRAM.items():
        (tmp_path / name).write_text(text.replace("LEVEL", "1.0"))
    by_paths = glisten.compile([tmp_path / name for name in PROGRAM])
    by_strings = glisten.compile([str(tmp_path / name) for name in PROGRAM])
    assert by_paths.wgsl("fragment") == by_strings.wgsl("fragment")
    (tmp_path / "odd.txt").write_text(VERTEX)
    assert glisten.compile(tmp_path / "odd.txt", stages={str(tmp_path / "odd.txt"): "vertex"}).stages == ["vertex"]
    with pytest.raises(FileNotFoundError):
        glisten.compile(tmp_path / "none.frag")


def test_errors_are_raised_with_their_diagnostics():
    with pytest.raises(glisten.CompileError) as caught:
        glisten.compile({"a.frag": "#version 150\nvoid main() { x; }\n"})
    assert "a.frag:2" in str(caught.value) and "^" in str(caught.value)
    first = caught.value.diagnostics[0]
    assert (first.severity, first.line, first.column, first.file) == ("error", 2, 15, "a.frag")
    assert str(first).startswith("a.frag:2:15: error[")
    program = glisten.compile(PROGRAM, defines={"LEVEL": "1.0"})
    for wrong in [lambda: program.emit("geometry", "wgsl"), lambda: program.emit("vertex", "cuda")]:
        with pytest.raises(ValueError):
            wrong()
    with pytest.raises(ValueError, match="did you mean `clip-z`"):
        glisten.compile(PROGRAM, clip_y="zero-to-one")
    with pytest.raises(ValueError, match="tells no stage"):
        glisten.compile({"a.txt": VERTEX})
    with pytest.raises(ValueError):
        glisten.compile({})


def test_lint_returns_what_is_wrong():
    sources = {"a.frag": "#version 150\nout vec4 c;\nvoid main() { float x; c = vec4(x); }\n"}
    found = glisten.lint(sources)
    assert found and all(one.severity != "error" for one in found)
    assert glisten.lint(sources, allow=[one.name for one in found]) == []
    denied = glisten.lint(sources, deny=[one.code for one in found])
    assert all(one.severity == "error" for one in denied)


def test_old_sources_are_rewritten(tmp_path):
    old = {
        "a.vert": "varying vec4 tint;\nvoid main() { tint = gl_Color; gl_Position = ftransform(); }\n",
        "a.frag": "varying vec4 tint;\nvoid main() { gl_FragColor = tint; }\n",
    }
    upgraded = glisten.upgrade(old, to="330")
    assert list(upgraded.texts) == list(old) and "out vec4 tint;" in upgraded.texts["a.vert"]
    assert any("`gl_Vertex` is `vertex`" in note for note in upgraded.notes)
    assert glisten.compile(upgraded.texts).stages == ["vertex", "fragment"]
    (tmp_path / "a.frag").write_text(old["a.frag"])
    assert "fragColor" in glisten.upgrade(tmp_path / "a.frag").texts[str(tmp_path / "a.frag")]
    with pytest.raises(glisten.CompileError, match="`x`"):
        glisten.upgrade({"a.frag": "void main() { x; }\n"})
    with pytest.raises(ValueError, match="gl_ClipVertex"):
        glisten.upgrade({"a.vert": "void main() { gl_ClipVertex = gl_Vertex; }\n"})
    with pytest.raises(ValueError, match="not a version"):
        glisten.upgrade(old, to="440")


def test_includes():
    sources = {"a.frag": '#version 150\n#include "l.glsl"\nout vec4 c;\nvoid main() { c = vec4(L); }\n'}
    asked = []

    def include(path, angled, source):
        asked.append((path, angled, source))
        return "#define L 0.25\n"

    assert "0.25" in glisten.compile(sources, include=include).wgsl("fragment")
    assert asked == [("l.glsl", False, "a.frag")]
    assert "0.25" in glisten.compile(sources, include={"l.glsl": "#define L 0.25\n"}).wgsl("fragment")
    with pytest.raises(glisten.CompileError):
        glisten.compile(sources, include=lambda *_: None)

    def broken(*_):
        raise KeyError("no such thing")

    with pytest.raises(KeyError):
        glisten.compile(sources, include=broken)
    with pytest.raises(TypeError):
        glisten.compile(sources, include=lambda *_: 7)


SCENE = {
    "s.toml": """[framebuffer]
width = 8
height = 4
[[draw]]
vertex = "v.vert"
fragment = "f.frag"
vertex_count = 3
""",
    "v.vert": """#version 150
void main() { gl_Position = vec4(vec2[](vec2(-1), vec2(1, -1), vec2(-1, 1))[gl_VertexID], 0.0, 1.0); }
""",
    "f.frag": """#version 150
out vec4 c;
void main() { c = vec4(gl_FragCoord.xy / 8.0, 0.5, 1.0); }
""",
}


def test_pictures_are_arrays(tmp_path):
    for name, text in SCENE.items():
        (tmp_path / name).write_text(text)
    picture = glisten.render(tmp_path / "s.toml")
    height, width, channels = picture.pixels.shape
    assert (width, height) == (8, 4) and np.array_equal(picture.pixels, glisten.render("s.toml", files=SCENE).pixels)
    assert repr(picture) == f"<Picture: 8 x 4, 1 attachment, {picture.covered.sum()} pixels covered>"
    assert channels == 4 and picture.pixels.dtype == np.float64 and picture.covered.shape == (height, width)
    assert picture.covered.any() and not picture.covered.all()
    assert picture.to_uint8().dtype == np.uint8
    picture.pixels[0, 0] = 0.5  # The array is the caller's.
    assert np.abs(glisten.render(tmp_path / "s.toml", precision="f32").pixels).sum() > 0
    with pytest.raises(FileNotFoundError) as missing:
        glisten.load("no such scene.toml")
    assert (missing.value.errno, missing.value.filename) == (errno.ENOENT, "no such scene.toml")
    with pytest.raises(IsADirectoryError):
        glisten.load(tmp_path)
    (tmp_path / "f.frag").unlink()
    with pytest.raises(FileNotFoundError) as missing:
        glisten.render(tmp_path / "s.toml")
    assert missing.value.filename == str(tmp_path / "f.frag")
    with pytest.raises(glisten.CompileError):
        glisten.load("s.toml", files={"s.toml": "[framebuffer]\nwidht = 3\n"})
    with pytest.raises(ValueError):
        glisten.load("s.toml", files=SCENE).render("f16")


def test_files_in_memory_are_those_on_a_disk():
    """Paths are without `.` and `..`, and includes are among the files."""
    draw = SCENE["s.toml"].replace("v.vert", "../v.vert").replace("f.frag", "f.frag")
    tinted = '#version 150\n#include "../parts/tint.glsl"\nout vec4 c;\nvoid main() { c = tint(); }\n'
    files = {
        "d/s.toml": draw,
        "./v.vert": SCENE["v.vert"],
        "d/f.frag": tinted,
        "parts/tint.glsl": '#include "one.glsl"\nvec4 tint() { return vec4(ONE); }\n',
        "parts/one.glsl": b"#define ONE 1.0\n",
    }
    assert glisten.render("./d/s.toml", files=files).covered.any()
    with pytest.raises(TypeError, match="not a `int`"):
        glisten.load("s.toml", files={"s.toml": 7})


def test_what_drawing_shows_has_diagnostics():
    endless = SCENE["f.frag"].replace("{ c =", "{ while (gl_FragCoord.x > -1.0) ; c =")
    with pytest.raises(glisten.CompileError) as raised:
        glisten.render("s.toml", files={**SCENE, "f.frag": endless})
    assert [(one.code, one.file) for one in raised.value.diagnostics] == [("E0913", "f.frag")]


def test_errors_can_be_copied():
    with pytest.raises(glisten.CompileError) as raised:
        glisten.compile({"a.frag": "#version 150\nvoid main() { x = 1; }\n"})
    for again in [pickle.loads(pickle.dumps(raised.value)), copy.copy(raised.value)]:
        assert type(again) is glisten.CompileError
        assert (str(again), again.diagnostics) == (str(raised.value), raised.value.diagnostics)


def test_wrong_arguments_are_named():
    for number in [-1, 99, 1 << 40]:
        with pytest.raises(ValueError, match=f"{number} is not a location"):
            glisten.compile(PROGRAM, attributes={"p": number})
    with pytest.raises(TypeError, match="`defines` is a mapping of names, not a `list`"):
        glisten.compile(PROGRAM, defines=["LEVEL"])


def test_threads_get_the_same_bytes():
    results = []
    run = lambda: results.append(glisten.compile(PROGRAM, defines={"LEVEL": "2.0"}).spirv("fragment"))
    threads = [threading.Thread(target=run) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and len(set(results)) == 1


def test_diagnostics_have_formats():
    program = glisten.compile(PROGRAM, defines={"LEVEL": "1.0"})
    assert json.loads(program.format_diagnostics("sarif"))["version"] == "2.1.0"
    with pytest.raises(ValueError):
        program.format_diagnostics("xml")


@pytest.mark.skipif(not EXAMPLE.exists(), reason="the example is in the repository")
def test_the_example_runs(capsys):
    runpy.run_path(str(EXAMPLE))
    assert capsys.readouterr().out.endswith("all is well\n")


def test_the_stubs_name_what_is_there():
    from glisten import _glisten

    stubs = (pathlib.Path(glisten.__file__).parent / "_glisten.pyi").read_text()
    for name in [name for name in dir(_glisten) if not name.startswith("_")]:
        assert f"class {name}" in stubs or f"def {name}(" in stubs or f"{name}: " in stubs, name
        for inner in [inner for inner in dir(getattr(_glisten, name)) if not inner.startswith("_")]:
            if isinstance(getattr(_glisten, name), type):
                assert f"def {inner}(" in stubs, f"{name}.{inner}"


def test_stubs_are_those_of_the_module(tmp_path):
    pytest.importorskip("mypy.stubtest", reason="mypy compares the stubs")
    run = subprocess.run([sys.executable, "-m", "mypy.stubtest", "glisten"], capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_wrong_options_are_no_types(tmp_path):
    """Lines that end in `# wrong` are errors, and no others."""
    source = tmp_path / "host.py"
    source.write_text(
        "import glisten\n"
        'glisten.compile("a.frag", clip_z="minus-one-to-one", deny=["warnings"], strict=True, clip_distances=2)\n'
        'glisten.compile("a.frag", clip_y=3)  # wrong\n'
        'glisten.lint("a.frag", clip_z="up")  # wrong\n'
        'glisten.render("s.toml", precision="f32", files={"s.toml": b""}, spirv_env="vulkan")\n'
        'glisten.render("s.toml", precision="f16")  # wrong\n'
        'glisten.load("s.toml", optimise=True)  # wrong\n'
        'glisten.upgrade("a.frag", to="440")  # wrong\n'
    )
    words = ["--strict", "--cache-dir", str(tmp_path / "cache"), str(source)]
    run = subprocess.run([sys.executable, "-m", "mypy", *words], capture_output=True, text=True, cwd=tmp_path)
    told = {int(line.split(":")[1]) for line in run.stdout.splitlines() if ": error:" in line}
    wrong = {number for number, line in enumerate(source.read_text().splitlines(), 1) if line.endswith("# wrong")}
    assert told == wrong, run.stdout + run.stderr

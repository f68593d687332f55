"""glisten for Python: lints, compiles and reflects OpenGL 3.2 era GLSL, and draws scenes to NumPy arrays.

>>> import glisten
>>> program = glisten.compile({"red.frag": "#version 150\\nout vec4 c;\\nvoid main() { c = vec4(1, 0, 0, 1); }\\n"})
>>> "@fragment" in program.wgsl("fragment")
True

Sources are paths, or a mapping of names to texts. The name tells the stage; of a text whose name tells none, macros in it do. What is wrong with a shader raises
:class:`CompileError`, whose ``diagnostics`` say where; :func:`lint` returns them instead. NumPy is needed for pictures alone.
"""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypedDict, TypeVar, Union

from . import _glisten

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from typing_extensions import Unpack

__version__: str = _glisten.VERSION
__all__ = [
    "CompileError", "Diagnostic", "Options", "Picture", "Program", "Scene", "Upgraded", "compile", "lint", "load", "render", "upgrade",
]  # fmt: skip

Sources = Union[Mapping[str, str], str, "os.PathLike[str]", Iterable[Union[str, "os.PathLike[str]"]]]
Include = Union[Callable[[str, bool, str], Union[str, None]], Mapping[str, str]]
_Result = TypeVar("_Result")


class Options(TypedDict, total=False):
    """The flags of ``glisten compile``, with underscores."""

    allow: str | Sequence[str]
    """Codes or names of findings that are left out."""
    assume_version: str
    """The version of sources without one: ``330``, ``150 core``."""
    clip_distances: int
    """How many clip distances the host has enabled, up to 8."""
    clip_z: Literal["zero-to-one", "minus-one-to-one"]
    """The range of depth in the host's clip space."""
    debug_lines: bool
    """Whether source lines are in SPIR-V."""
    deny: str | Sequence[str]
    """Codes or names of findings that are errors, or ``warnings``."""
    engine: str
    """The engine that completes the sources: ``three``, ``minecraft`` and so on."""
    floats: Literal["f16", "f32", "f64"]
    """The width of ``float`` in the code."""
    glsl_version: Literal["330", "450", "300es", "vulkan"]
    """The version of emitted GLSL."""
    include_style: str
    """How sources name the files that they include: ``quote``, ``three`` and so on."""
    optimize: bool
    """Whether what reaches no output is left out."""
    point_sprites: bool
    """Whether points have coordinates, as by ``GL_POINT_SPRITE``."""
    prelude: str | Sequence[str]
    """Texts before each source."""
    program_point_size: bool
    """Whether the shader sets the size of points."""
    spirv_env: Literal["webgpu", "vulkan"]
    """Who reads SPIR-V."""
    strict: bool
    """Whether what drivers accept against the specification is an error."""
    warn: str | Sequence[str]
    """Codes or names of findings that are warnings."""
    window_origin: Literal["upper-left", "lower-left"]
    """The corner of the window where ``gl_FragCoord`` begins."""


@dataclass(frozen=True)
class Diagnostic:
    """What is wrong at a place. Lines and columns count from 1; ``end_column`` is exclusive."""

    severity: str
    """``error``, ``warning`` or ``note``"""
    code: str
    """The code, such as ``E0301``."""
    name: str
    """The name of the code, such as ``undeclared-identifier``."""
    message: str
    """The message."""
    help: str | None
    """The help text."""
    file: str
    """The name of the file."""
    line: int
    """The first line."""
    column: int
    """The first column."""
    end_line: int
    """The last line."""
    end_column: int
    """The column after the last."""
    notes: tuple[str, ...]
    """Facts that need no place."""
    section: str | None
    """The section of the specification."""

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}: {self.severity}[{self.code}]: {self.message}"

    @classmethod
    def _all(cls, text: str) -> list[Diagnostic]:
        rows = json.loads(text)
        return [cls(notes=tuple(row["notes"]), **{key: row[key] for key in _KEYS}) for row in rows]


_KEYS = (
    "severity", "code", "name", "message", "help", "file", "line", "column", "end_line", "end_column", "section",
)  # fmt: skip


class CompileError(ValueError):
    """A shader or a scene has errors. The message shows them with excerpts."""

    def __init__(self, message: str, diagnostics: list[Diagnostic]) -> None:
        super().__init__(message)
        self.diagnostics: list[Diagnostic] = diagnostics
        """All diagnostics, in the order of their places."""

    def __reduce__(self) -> tuple[Any, ...]:
        # Pickles and copies call the class with what it takes, and not with the message alone.
        return type(self), (str(self), self.diagnostics), vars(self)


class Program:
    """A compiled program. It never changes, and any number of threads may use it."""

    def __init__(self, inner: _glisten.Program) -> None:
        self._inner = inner

    @property
    def stages(self) -> list[str]:
        """The stages in the order of the pipeline; none if there are errors."""
        return self._inner.stages

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All diagnostics, in the order of their places."""
        return Diagnostic._all(self._inner.diagnostics("json"))

    def format_diagnostics(self, format: str = "human") -> str:
        """The diagnostics as a text: ``human``, ``json``, ``sarif`` or ``github``."""
        return self._inner.diagnostics(format)

    def emit(self, stage: str, target: str) -> bytes:
        """The code of a stage: ``wgsl``, ``spirv``, ``msl``, ``hlsl`` or ``glsl``.

        :raises CompileError: the target cannot represent something of the program.
        :raises ValueError: the program has no such stage.
        """
        return _told(lambda: self._inner.emit(stage, target))

    def wgsl(self, stage: str) -> str:
        """The code of a stage in WGSL."""
        return self.emit(stage, "wgsl").decode()

    def spirv(self, stage: str) -> bytes:
        """The code of a stage in SPIR-V, the least significant byte of each word first."""
        return self.emit(stage, "spirv")

    def msl(self, stage: str) -> str:
        """The code of a stage in MSL."""
        return self.emit(stage, "msl").decode()

    def hlsl(self, stage: str) -> str:
        """The code of a stage in HLSL."""
        return self.emit(stage, "hlsl").decode()

    def glsl(self, stage: str) -> str:
        """The code of a stage in GLSL of the option ``glsl_version``."""
        return self.emit(stage, "glsl").decode()

    @property
    def reflection(self) -> dict[str, Any]:
        """What a host needs to know: attributes, uniforms with their offsets, bindings, varyings, outputs.

        Its form is ``docs/reflection.schema.json``.
        """
        reflection: dict[str, Any] = json.loads(self._inner.reflect())
        return reflection


@dataclass(frozen=True, repr=False, eq=False)
class Picture:
    """What was drawn. Row 0 is the top row."""

    attachments: tuple[npt.NDArray[np.float64], ...]
    """RGBA of each color attachment: height x width x 4."""
    covered: npt.NDArray[np.bool_]
    """Whether a fragment was written to the pixel: height x width."""

    def __repr__(self) -> str:
        height, width = self.covered.shape
        count = len(self.attachments)
        return f"<Picture: {width} x {height}, {count} attachment{'s' * (count != 1)}, {self.covered.sum()} pixels covered>"

    @property
    def pixels(self) -> npt.NDArray[np.float64]:
        """The first attachment."""
        return self.attachments[0]

    def to_uint8(self) -> npt.NDArray[np.uint8]:
        """The first attachment as bytes: clamped to [0, 1] and scaled to 255, without gamma. NaN is 0."""
        import numpy as np

        channels = np.nan_to_num(self.pixels, nan=0.0, posinf=1.0, neginf=0.0)
        return np.floor(255.0 * np.clip(channels, 0.0, 1.0) + 0.5).astype(np.uint8)


class Scene:
    """A scene with its programs. It never changes, and any number of threads may use it."""

    def __init__(self, inner: _glisten.Scene) -> None:
        self._inner = inner

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All diagnostics, in the order of their places."""
        return Diagnostic._all(self._inner.diagnostics("json"))

    def render(self, precision: Literal["f64", "f32"] = "f64") -> Picture:
        """Draws the scene with the CPU reference, in ``f64`` or ``f32`` arithmetic.

        :raises CompileError: the scene has something that the reference does not support, or a loop that does not end.
        """
        import numpy as np

        width, height, attachments, covered = _told(lambda: self._inner.render(precision))
        shape = (height, width, 4)
        arrays = (np.frombuffer(attachment, dtype=np.float64).reshape(shape) for attachment in attachments)
        return Picture(tuple(arrays), np.frombuffer(covered, dtype=np.bool_).reshape(shape[:2]))

    def stability(self) -> dict[str, Any]:
        """How f32 arithmetic harms the picture: ``verdict``, ``picture``, ``causes``, as ``glisten stability`` tells it."""
        findings: dict[str, Any] = json.loads(_told(self._inner.stability))
        return findings


def compile(
    sources: Sources,
    *,
    defines: Mapping[str, object] | None = None,
    include: Include | None = None,
    include_folders: Iterable[str | os.PathLike[str]] = (),
    attributes: Mapping[str, int] | None = None,
    outputs: Mapping[str, int] | None = None,
    stages: Mapping[str, str] | None = None,
    **options: Unpack[Options],
) -> Program:
    """Compiles the sources of one program.

    :param sources: paths, or a mapping of names to texts.
    :param defines: macros that are defined before the first line; ``True`` is 1.
    :param include: a function of the path, whether it is in angle brackets, and the including file, which returns the text or
        ``None``; or a mapping of paths to texts. It is asked before the folders and the library.
    :param include_folders: the search path of ``#include``.
    :param attributes: locations of vertex attributes, as by ``glBindAttribLocation``.
    :param outputs: color numbers of fragment outputs, as by ``glBindFragDataLocation``.
    :param stages: stages of sources whose names do not tell them.
    :param options: the flags of ``glisten compile`` with underscores: ``clip_z="minus-one-to-one"``, ``strict=True``,
        ``deny="warnings"``, ``allow=["unused-varying"]``.
    :raises CompileError: the sources have errors.
    """
    settings = _settings(defines, include, include_folders, attributes, outputs, options)
    inner = _glisten.compile(settings, _texts(sources, stages), False)
    if not inner.is_sound:
        raise CompileError(inner.diagnostics("human").rstrip(), Diagnostic._all(inner.diagnostics("json")))
    return Program(inner)


def lint(
    sources: Sources,
    *,
    defines: Mapping[str, object] | None = None,
    include: Include | None = None,
    include_folders: Iterable[str | os.PathLike[str]] = (),
    attributes: Mapping[str, int] | None = None,
    outputs: Mapping[str, int] | None = None,
    stages: Mapping[str, str] | None = None,
    **options: Unpack[Options],
) -> list[Diagnostic]:
    """Checks the sources of one program: errors, warnings, and what is legal but will hurt. Parameters are those of
    :func:`compile`."""
    settings = _settings(defines, include, include_folders, attributes, outputs, options)
    return Diagnostic._all(_glisten.compile(settings, _texts(sources, stages), True).diagnostics("json"))


@dataclass(frozen=True)
class Upgraded:
    """The sources of a program in another version."""

    texts: dict[str, str]
    """The new text of each source, by its name."""
    notes: tuple[str, ...]
    """Sentences for the author of the host."""


def upgrade(
    sources: Sources,
    *,
    to: Literal["150", "330", "450", "460", "300es", "vulkan"] = "150",
    defines: Mapping[str, object] | None = None,
    include: Include | None = None,
    include_folders: Iterable[str | os.PathLike[str]] = (),
    stages: Mapping[str, str] | None = None,
    **options: Unpack[Options],
) -> Upgraded:
    """Rewrites sources of GLSL 1.10 to 1.40, of the compatibility profile or of ES 1.00, as ``glisten upgrade`` does. Files that they
    include stay as they are.

    :param to: the version to write.
    :raises CompileError: the sources have errors.
    :raises ValueError: a source is newer than the version, or has a name that the version has no counterpart for.
    """
    settings = _settings(defines, include, include_folders, None, None, options)
    texts = _texts(sources, stages)
    inner = _glisten.upgrade(settings, texts, to)
    if not inner.is_sound:
        raise CompileError(inner.diagnostics("human").rstrip(), Diagnostic._all(inner.diagnostics("json")))
    return Upgraded({name: new for (name, _, _), new in zip(texts, inner.texts)}, tuple(inner.notes))


def load(
    path: str | os.PathLike[str],
    *,
    files: Mapping[str, str | bytes] | None = None,
    include: Include | None = None,
    include_folders: Iterable[str | os.PathLike[str]] = (),
    **options: Unpack[Options],
) -> Scene:
    """Loads a scene file with its programs.

    :param files: the contents of all files by their paths, included files among them; without it, they are on disk.
    :raises CompileError: the scene or one of its shaders has errors.
    :raises OSError: a file cannot be read; ``errno`` and ``filename`` say why and which.
    """
    settings = _settings(None, include, include_folders, None, None, options)
    contents = None
    if files is not None:
        contents = {os.fspath(name): _bytes(name, file) for name, file in _mapping("files", files).items()}
    inner = _glisten.load(settings, os.fspath(path), contents)
    if not inner.is_sound:
        raise CompileError(inner.diagnostics("human").rstrip(), Diagnostic._all(inner.diagnostics("json")))
    return Scene(inner)


def render(
    path: str | os.PathLike[str],
    *,
    precision: Literal["f64", "f32"] = "f64",
    files: Mapping[str, str | bytes] | None = None,
    include: Include | None = None,
    include_folders: Iterable[str | os.PathLike[str]] = (),
    **options: Unpack[Options],
) -> Picture:
    """Loads a scene and draws it. Parameters are those of :func:`load` and :meth:`Scene.render`."""
    return load(path, files=files, include=include, include_folders=include_folders, **options).render(precision)


def _settings(
    defines: Mapping[str, object] | None,
    include: Include | None,
    include_folders: Iterable[str | os.PathLike[str]],
    attributes: Mapping[str, int] | None,
    outputs: Mapping[str, int] | None,
    options: Options,
) -> _glisten.Settings:
    texts = dict(include) if isinstance(include, Mapping) else {}
    ask = (lambda path, _angled, _from: texts.get(path)) if isinstance(include, Mapping) else include

    return _glisten.Settings(
        [(name.replace("_", "-"), word) for name, value in options.items() for word in _words(value)],
        [(name, _word(value, "1", "0")) for name, value in _mapping("defines", defines).items()],
        [os.fspath(folder) for folder in include_folders],
        ask,
        _numbers("attributes", attributes),
        _numbers("outputs", outputs),
    )


def _told(call: Callable[[], _Result]) -> _Result:
    """The result of a call, whose diagnostics are those of a :class:`CompileError`."""
    try:
        return call()
    except ValueError as error:
        if len(error.args) != 2:
            raise
        message, diagnostics = error.args
    raise CompileError(message, Diagnostic._all(diagnostics))


def _mapping(name: str, value: Mapping[str, _Result] | None) -> Mapping[str, _Result]:
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise TypeError(f"`{name}` is a mapping of names, not a `{type(value).__name__}`")
    return value


def _numbers(name: str, given: Mapping[str, int] | None) -> list[tuple[str, int]]:
    """Locations by names. The rest of their range is checked where it is known."""
    numbers = [(key, operator.index(number)) for key, number in _mapping(name, given).items()]
    for key, number in numbers:
        if not 0 <= number < 1 << 32:
            raise ValueError(f"{number} is not a location that `{key}` could have")
    return numbers


def _bytes(name: object, content: object) -> bytes:
    if isinstance(content, str):
        return content.encode()
    if isinstance(content, (bytes, bytearray, memoryview)):
        return bytes(content)
    raise TypeError(f"the content of `{name}` is a text or bytes, not a `{type(content).__name__}`")


def _words(value: object) -> list[str]:
    """The values of an option: a list sets it several times."""
    return [_word(one) for one in (value if isinstance(value, (list, tuple)) else [value])]


def _word(value: object, true: str = "true", false: str = "false") -> str:
    return {True: true, False: false}[value] if isinstance(value, bool) else str(value)


def _texts(sources: Sources, stages: Mapping[str, str] | None) -> list[tuple[str, str, str | None]]:
    stage_of = dict(stages or {})
    if isinstance(sources, Mapping):
        return [(name, text, stage_of.get(name)) for name, text in sources.items()]
    paths = [sources] if isinstance(sources, (str, os.PathLike)) else list(sources)
    names = [os.fspath(path) for path in paths]
    return [(name, _read(name), stage_of.get(name)) for name in names]


def _read(path: str) -> str:
    # Bytes that are not UTF-8 are legal in comments alone, and glisten says where they are not.
    with open(path, encoding="utf-8", errors="replace", newline="") as file:
        return file.read()

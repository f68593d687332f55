"""The extension module that `glisten` is built on. Use `glisten`: this may change."""

from collections.abc import Callable
from typing import final

__all__ = ["Program", "Scene", "Settings", "VERSION", "compile", "load"]

VERSION: str

@final
class Settings:
    def __new__(
        cls,
        options: list[tuple[str, str]],
        defines: list[tuple[str, str]],
        folders: list[str],
        include: Callable[[str, bool, str], str | None] | None,
        attributes: list[tuple[str, int]],
        outputs: list[tuple[str, int]],
    ) -> Settings: ...

@final
class Program:
    @property
    def is_sound(self) -> bool: ...
    @property
    def stages(self) -> list[str]: ...
    def emit(self, stage: str, target: str) -> bytes: ...
    def reflect(self) -> str: ...
    def diagnostics(self, name: str) -> str: ...

@final
class Scene:
    @property
    def is_sound(self) -> bool: ...
    def diagnostics(self, name: str) -> str: ...
    def render(self, precision: str) -> tuple[int, int, list[bytearray], bytearray]: ...
    def stability(self) -> str: ...

def compile(settings: Settings, sources: list[tuple[str, str, str | None]], lints: bool) -> Program: ...
def load(settings: Settings, path: str, files: dict[str, bytes] | None) -> Scene: ...

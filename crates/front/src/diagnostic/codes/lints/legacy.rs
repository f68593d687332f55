//! Lint rules of the group `legacy`: what later versions replaced.

lints! {}

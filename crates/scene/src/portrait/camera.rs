//! Writes the camera and the lights of a portrait.
//!
//! *In:* a [`Framing`]. *Out:* tables of a scene. *Holds:* numbers are rounded to what matters for a model of its size.

use super::{number, triple};
use crate::geometry::{DOME, Framing, Projection};
use glam::DVec3;
use std::fmt::Write;

/// Writes `[camera]` and the lights.
pub(super) fn write(framing: &Framing, text: &mut String) {
    let point = |point: DVec3| triple(point.to_array(), framing.size);
    let _ = write!(text, "\n[camera]\neye = {}\ntarget = {}\n", point(framing.eye), point(framing.target));
    if framing.up != DVec3::Y {
        let _ = writeln!(text, "up = {}", triple(framing.up.to_array(), 1.0));
    }
    let _ = match framing.projection {
        Projection::Perspective(angle) => writeln!(text, "fovy = {}", number(angle, 1.0)),
        Projection::Orthographic(half) => writeln!(text, "ortho = {}", number(half, half)),
    };
    let _ = writeln!(text, "near = {}\nfar = {}", number(framing.near, framing.near), number(framing.far, framing.far));
    for (comment, towards, color) in framing.lights() {
        let _ = write!(
            text,
            "\n# {comment}.\n[[light]]\nkind = \"directional\"\ntowards = {}\ncolor = {}\n",
            triple(towards.to_array(), 1.0),
            triple(color, 1.0)
        );
    }
    let _ = write!(text, "\n# Sky and ground, which metals mirror.\n{DOME}");
}

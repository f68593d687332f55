//! Writes the camera and the lights of a glTF file as tables of a scene.
//!
//! *In:* its camera and lights. *Out:* TOML. *Holds:* every number is written so that it reads as itself.

use crate::geometry::{DOME, Framing, Lamp, LampKind, ModelCamera, Projection};
use glam::{DMat4, DVec3};
use std::fmt::Write;

/// The factor of lengths of a transform.
fn scale_of(transform: DMat4) -> f64 {
    transform.determinant().abs().cbrt()
}

/// `[camera]` for a camera of the file; one without a far plane sees all of these points.
pub(super) fn camera(text: &mut String, camera: &ModelCamera, transform: DMat4, points: &[DVec3]) {
    let scale = scale_of(transform);
    let eye = transform.transform_point3(camera.eye);
    let forward = transform.transform_vector3(camera.forward).normalize_or(camera.forward);
    let up = transform.transform_vector3(camera.up).normalize_or(camera.up);
    let near = camera.near * scale;
    let deepest = points.iter().map(|point| (*point - eye).dot(forward)).fold(near, f64::max);
    // Where no file has anything to see, the draws of the scene are somewhere.
    let infinite = if points.is_empty() { near * 1e4 } else { (deepest * 1.1).max(near * 2.0) };
    let far = camera.far.map_or(infinite, |far| far * scale);
    let projection = match camera.projection {
        Projection::Orthographic(half) => Projection::Orthographic(half * scale),
        other => other,
    };
    view(text, [eye, eye + forward * deepest.max(near), up], projection, [near, far]);
}

/// `[camera]` for a camera that frames the file.
pub(super) fn framing(text: &mut String, framing: &Framing) {
    view(text, [framing.eye, framing.target, framing.up], framing.projection, [framing.near, framing.far]);
}

fn view(text: &mut String, [eye, target, up]: [DVec3; 3], projection: Projection, [near, far]: [f64; 2]) {
    let _ = writeln!(
        text,
        "[camera]\neye = {}\ntarget = {}\nup = {}\nnear = {near:?}\nfar = {far:?}",
        triple(eye.to_array()),
        triple(target.to_array()),
        triple(up.to_array())
    );
    let _ = match projection {
        Projection::Perspective(angle) => writeln!(text, "fovy = {angle:?}"),
        Projection::Orthographic(half) => writeln!(text, "ortho = {half:?}"),
    };
}

/// The lights of a model that nothing lights.
pub(super) fn portrait_lights(text: &mut String, framing: &Framing) {
    for (_, towards, color) in framing.lights() {
        let _ = writeln!(
            text,
            "[[light]]\nkind = \"directional\"\ntowards = {}\ncolor = {}",
            triple(towards.to_array()),
            triple(color)
        );
    }
    text.push_str(DOME);
}

/// `[[light]]` for a light of the file. With the lengths, the light grows so that it is as bright on what it lights.
pub(super) fn lamp(text: &mut String, lamp: &Lamp, transform: DMat4) {
    let scale = scale_of(transform);
    let position = triple(transform.transform_point3(lamp.position).to_array());
    let direction = transform.transform_vector3(lamp.direction).normalize_or(lamp.direction);
    let (kind, range) = match lamp.kind {
        LampKind::Directional => {
            let (towards, color) = (triple((-direction).to_array()), triple(lamp.color));
            let _ = writeln!(text, "[[light]]\nkind = \"directional\"\ntowards = {towards}\ncolor = {color}");
            return;
        }
        LampKind::Point(range) => ("point", range),
        LampKind::Spot(range, _) => ("spot", range),
    };
    let color = triple(lamp.color.map(|channel| channel * scale * scale));
    let _ = writeln!(text, "[[light]]\nkind = \"{kind}\"\nposition = {position}\ncolor = {color}");
    let _ = match range {
        Some(range) => writeln!(text, "range = {:?}", range * scale),
        None => writeln!(text, "attenuation = [0.0, 0.0, 1.0]"),
    };
    if let LampKind::Spot(_, [inner, outer]) = lamp.kind {
        let _ = writeln!(text, "direction = {}\ncone = [{inner:?}, {outer:?}]", triple(direction.to_array()));
    }
}

fn triple(values: [f64; 3]) -> String {
    let [x, y, z] = values.map(|value| value + 0.0);
    format!("[{x:?}, {y:?}, {z:?}]")
}

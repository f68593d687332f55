//! A camera and lights that show a model.
//!
//! *In:* a [`Model`], or its points. *Out:* a view from the front, the right and above that just contains every vertex, or the file's own
//! camera; three lights that go with it: a key, a fill and a rim light. *Holds:* the near and the far plane enclose the model.

use super::{Model, ModelCamera, Projection};
use glam::DVec3;

/// From the model towards the camera: a three-quarter view.
const TOWARDS_CAMERA: DVec3 = DVec3::new(0.55, 0.42, 1.0);
/// The vertical angle of the view in degrees.
const FOVY: f64 = 35.0;
/// How much of the picture's half the model fills.
const FILL: f64 = 0.92;

/// Sky and ground, which metals mirror: a table of a scene.
pub(crate) static DOME: &str =
    "[[light]]\nkind = \"hemisphere\"\nsky = [0.16, 0.18, 0.22]\nground = [0.05, 0.047, 0.043]\n";

/// The lights: a comment, and where each is: rightwards, upwards, towards the camera; its color.
static LIGHTS: &[(&str, DVec3, [f64; 3])] = &[
    ("Key: from above, left of the camera", DVec3::new(-0.55, 0.75, 0.7), [0.95, 0.92, 0.86]),
    ("Fill: softer, from the right", DVec3::new(0.9, 0.1, 0.6), [0.22, 0.25, 0.3]),
    ("Rim: from behind", DVec3::new(0.45, 0.7, -0.9), [0.5, 0.5, 0.55]),
];

/// A camera for a model.
pub(crate) struct Framing {
    pub(crate) eye: DVec3,
    pub(crate) target: DVec3,
    pub(crate) up: DVec3,
    pub(crate) projection: Projection,
    pub(crate) near: f64,
    pub(crate) far: f64,
    /// The size of what is seen, which says how exact numbers must be.
    pub(crate) size: f64,
}

impl Framing {
    /// The file's camera if it sees the model, otherwise one that frames it. `None` if the model has no extent.
    pub(crate) fn of(model: &Model) -> Option<Self> {
        let points = model.parts.iter().flat_map(|part| &part.soup.positions);
        let points: Vec<DVec3> = points.copied().map(DVec3::from).collect();
        let (_, size) = extent(&points)?;
        let own = model.camera.as_ref().and_then(|camera| Self::of_file(camera, &points, size));
        own.or_else(|| Self::of_points(&points))
    }

    /// A camera that frames points; `None` if they have no extent.
    pub(crate) fn of_points(points: &[DVec3]) -> Option<Self> {
        extent(points).map(|(center, size)| Self::around(points, center, size))
    }

    fn around(points: &[DVec3], center: DVec3, size: f64) -> Self {
        let back = TOWARDS_CAMERA.normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let extent = |axis: DVec3| {
            let along = || points.iter().map(|point| (*point - center).dot(axis));
            (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max))
        };
        let middle = |axis: DVec3| {
            let (low, high) = extent(axis);
            axis * ((low + high) / 2.0)
        };
        let target = center + middle(right) + middle(up);
        let slope = (FOVY / 2.0).to_radians().tan() * FILL;
        let distance = |point: &DVec3| {
            let at = *point - target;
            at.dot(right).abs().max(at.dot(up).abs()) / slope + at.dot(back)
        };
        let distance = points.iter().map(distance).fold(size / 100.0, f64::max);
        let (low, high) = extent(back);
        let near = ((distance - high) * 0.9).max(distance * 0.01);
        let far = ((distance - low) * 1.1).max(near * 2.0);
        let projection = Projection::Perspective(FOVY);
        Self { eye: target + back * distance, target, up: DVec3::Y, projection, near, far, size }
    }

    /// The file's camera, if it has some of the points before it.
    fn of_file(camera: &ModelCamera, points: &[DVec3], size: f64) -> Option<Self> {
        let depth = |point: &DVec3| (*point - camera.eye).dot(camera.forward);
        let slope = |point: &DVec3| (*point - camera.eye).reject_from(camera.forward).length() / depth(point).max(1e-9);
        let reach = match camera.projection {
            Projection::Perspective(angle) => (angle / 2.0).to_radians().tan() * 1.42,
            Projection::Orthographic(_) => f64::INFINITY,
        };
        let is_seen = points.iter().any(|point| depth(point) > camera.near && slope(point) < reach);
        if !is_seen || camera.forward.cross(camera.up).length() < 1e-6 {
            return None;
        }
        let deepest = points.iter().map(depth).fold(camera.near, f64::max);
        let far = camera.far.unwrap_or(deepest * 1.1).max(camera.near * 2.0);
        let target = camera.eye + camera.forward * (deepest / 2.0).max(camera.near);
        let (eye, up, projection, near) = (camera.eye, camera.up, camera.projection, camera.near);
        Some(Self { eye, target, up, projection, near, far, size: size.min(deepest) })
    }

    /// The lights: a comment, the direction towards each, its color.
    pub(crate) fn lights(&self) -> impl Iterator<Item = (&'static str, DVec3, [f64; 3])> {
        let back = (self.eye - self.target).normalize_or(DVec3::Z);
        let right = self.up.cross(back).normalize_or(DVec3::X);
        let up = back.cross(right);
        let towards = move |place: DVec3| (right * place.x + up * place.y + back * place.z).normalize();
        LIGHTS.iter().map(move |(comment, place, color)| (*comment, towards(*place), *color))
    }
}

/// The center and the size of points; `None` if they have no extent.
fn extent(points: &[DVec3]) -> Option<(DVec3, f64)> {
    let low = points.iter().copied().reduce(DVec3::min)?;
    let high = points.iter().copied().reduce(DVec3::max)?;
    let size = (high - low).length();
    (size > 0.0).then_some(((low + high) / 2.0, size))
}

//! `[camera]`, `[draw.camera]`, `[draw.transform]`: the matrices that `[draw.matrices]` assigns to uniforms by role.
//!
//! *In:* the eye, the target and so on, in degrees and world units. *Out:* column-major matrices, computed in f64 and
//! rounded once to f32. *Holds:* eye space is right-handed and looks down -z; clip-space z is in `[-w, w]`, as with
//! `gluLookAt` and `gluPerspective`.

use crate::model::Framebuffer;
use crate::roles::MatrixRole as Role;
use crate::tables::Reader;
use glam::{DMat3, DMat4, DQuat, DVec3};
use glisten_front::hir::Type;
use toml::de::DeTable;

/// The roles by name.
pub(super) const ROLES: &[(&str, Role)] = Role::NAMES;

const CAMERA_KEYS: &[&str] = &["eye", "target", "up", "fovy", "aspect", "near", "far", "ortho"];
const TRANSFORM_KEYS: &[&str] = &["translate", "rotate", "scale"];

/// The model, view and projection of a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    model: DMat4,
    view: DMat4,
    projection: DMat4,
    eye: DVec3,
}

impl View {
    /// The matrices of a draw: from its own camera, or the scene's, or the identity.
    pub(super) fn load(
        reader: &mut Reader,
        draw: &DeTable<'_>,
        scene_camera: Option<&DeTable<'_>>,
        framebuffer: &Framebuffer,
    ) -> Self {
        let own = reader.table_at(draw, "camera");
        let mut view =
            Self { model: DMat4::IDENTITY, view: DMat4::IDENTITY, projection: DMat4::IDENTITY, eye: DVec3::ZERO };
        if let Some(camera) = own.or(scene_camera) {
            view.look(reader, camera, f64::from(framebuffer.width) / f64::from(framebuffer.height));
        }
        if let Some(transform) = reader.table_at(draw, "transform") {
            view.model = load_transform(reader, transform);
        }
        view
    }

    /// The matrix from world space to the clip space of a camera.
    pub(super) fn of_camera(reader: &mut Reader, camera: &DeTable<'_>, aspect: f64) -> DMat4 {
        let [view, projection] = [DMat4::IDENTITY; 2];
        let mut seen = Self { model: DMat4::IDENTITY, view, projection, eye: DVec3::ZERO };
        seen.look(reader, camera, aspect);
        seen.projection * seen.view
    }

    fn look(&mut self, reader: &mut Reader, camera: &DeTable<'_>, aspect: f64) {
        reader.check_keys(camera, "a camera", CAMERA_KEYS);
        self.eye = DVec3::from(reader.reals(camera, "eye", [0.0, 0.0, 3.0]));
        let target = DVec3::from(reader.reals(camera, "target", [0.0; 3]));
        let up = DVec3::from(reader.reals(camera, "up", [0.0, 1.0, 0.0]));
        let aspect = reader.real(camera, "aspect", aspect);
        let near = reader.real(camera, "near", 0.1);
        let far = reader.real(camera, "far", 100.0);
        require(reader, camera, &["aspect"], aspect > 0.0, "the `aspect` of a camera is more than 0");
        require(reader, camera, &["target", "eye"], target != self.eye, "the `eye` and the `target` are at one place");
        let side = (target - self.eye).cross(up).length();
        let least = FLAT * (target - self.eye).length() * up.length();
        let looks = target == self.eye || side > least;
        require(reader, camera, &["up", "target", "eye"], looks, "`up` points along the view, or nowhere");
        self.view = look_at(self.eye, target, up);
        self.projection = if camera.contains_key("ortho") {
            let half_height = reader.real(camera, "ortho", 1.0);
            require(
                reader,
                camera,
                &["ortho"],
                half_height > 0.0,
                "`ortho` is half the height of the view, more than 0",
            );
            require(reader, camera, &["far", "near"], far > near, "`far` is more than `near`");
            orthographic(half_height * aspect, half_height, near, far)
        } else {
            let fovy = reader.real(camera, "fovy", 45.0);
            require(
                reader,
                camera,
                &["fovy"],
                fovy > 0.0 && fovy < 180.0,
                "`fovy` is an angle between 0 and 180 degrees",
            );
            require(reader, camera, &["near"], near > 0.0, "`near` is more than 0: the planes are in front of the eye");
            require(reader, camera, &["far", "near"], near <= 0.0 || far > near, "`far` is more than `near`");
            perspective(fovy.to_radians(), aspect, near, far)
        };
    }

    /// The matrix from object space to world space.
    pub(super) fn model(&self) -> DMat4 {
        self.model
    }

    /// The matrix from object space to eye space.
    pub(super) fn model_view(&self) -> DMat4 {
        self.view * self.model
    }

    /// The matrix from eye space to clip space.
    pub(super) fn projection(&self) -> DMat4 {
        self.projection
    }

    /// The matrix from world space to eye space.
    pub(super) fn view_matrix(&self) -> DMat4 {
        self.view
    }

    /// The numbers of a role for a uniform of this type; `None` if the role does not fit it.
    pub(super) fn matrix(&self, role: Role, ty: Type) -> Option<Vec<f32>> {
        let model_view = self.view * self.model;
        let model_view_projection = self.projection * model_view;
        let four = |matrix: DMat4| round(&matrix.to_cols_array());
        let normal = |matrix: DMat4| {
            let normal = DMat3::from_mat4(matrix).inverse().transpose();
            if ty == Type::Matrix(3, 3) { round(&normal.to_cols_array()) } else { four(DMat4::from_mat3(normal)) }
        };
        role.fits(ty).then(|| match role {
            Role::Model => four(self.model),
            Role::View => four(self.view),
            Role::Projection => four(self.projection),
            Role::ModelView => four(model_view),
            Role::ViewProjection => four(self.projection * self.view),
            Role::ModelViewProjection => four(model_view_projection),
            Role::ModelInverse => four(self.model.inverse()),
            Role::ViewInverse => four(self.view.inverse()),
            Role::ProjectionInverse => four(self.projection.inverse()),
            Role::ModelViewInverse => four(model_view.inverse()),
            Role::ViewProjectionInverse => four((self.projection * self.view).inverse()),
            Role::ModelViewProjectionInverse => four(model_view_projection.inverse()),
            Role::Normal => normal(model_view),
            Role::ModelNormal => normal(self.model),
            Role::Eye => round(&self.eye.to_array()),
        })
    }
}

/// The sine of the angle between `up` and the view below which they are one direction.
const FLAT: f64 = 1e-9;

/// Reports the first of the keys that the camera has, if its view is impossible.
fn require(reader: &mut Reader, camera: &DeTable<'_>, keys: &[&str], holds: bool, rule: &str) {
    if let Some(node) = keys.iter().find_map(|key| camera.get(*key)).filter(|_| !holds) {
        let span = reader.span_of(node);
        reader.wrong_value(span, rule, "there is no such view");
    }
}

fn round(numbers: &[f64]) -> Vec<f32> {
    numbers.iter().map(|&number| number as f32).collect()
}

/// `gluLookAt`
fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    let forward = (target - eye).normalize();
    let side = forward.cross(up).normalize();
    let up = side.cross(forward);
    let rotation = DMat3::from_cols(side, up, -forward).transpose();
    DMat4::from_mat3(rotation) * DMat4::from_translation(-eye)
}

/// `gluPerspective`, `fovy` in radians.
pub(super) fn perspective(fovy: f64, aspect: f64, near: f64, far: f64) -> DMat4 {
    let f = 1.0 / (fovy / 2.0).tan();
    DMat4::from_cols_array(&[
        f / aspect,
        0.0,
        0.0,
        0.0,
        0.0,
        f,
        0.0,
        0.0,
        0.0,
        0.0,
        (far + near) / (near - far),
        -1.0,
        0.0,
        0.0,
        2.0 * far * near / (near - far),
        0.0,
    ])
}

/// `glOrtho` of a box around the axis.
fn orthographic(half_width: f64, half_height: f64, near: f64, far: f64) -> DMat4 {
    let scale = DVec3::new(1.0 / half_width, 1.0 / half_height, -2.0 / (far - near));
    let shift = DVec3::new(0.0, 0.0, -(far + near) / (far - near));
    DMat4::from_translation(shift) * DMat4::from_scale(scale)
}

/// Scales first, then rotates (degrees about x, then y, then z; or `[degrees, x, y, z]` about an axis), then
/// translates.
pub(super) fn load_transform(reader: &mut Reader, table: &DeTable<'_>) -> DMat4 {
    reader.check_keys(table, "a transform", TRANSFORM_KEYS);
    let translate = DVec3::from(reader.reals(table, "translate", [0.0; 3]));
    let about_axis = table.get("rotate").and_then(|node| node.get_ref().as_array()).is_some_and(|list| list.len() == 4);
    let rotation = if about_axis {
        let [degrees, x, y, z] = reader.reals(table, "rotate", [0.0, 0.0, 0.0, 1.0]);
        DQuat::from_axis_angle(DVec3::new(x, y, z).normalize_or(DVec3::Z), degrees.to_radians())
    } else {
        let [x, y, z] = reader.reals(table, "rotate", [0.0; 3]).map(f64::to_radians);
        DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x)
    };
    let scale = match table.get("scale") {
        Some(node) if node.get_ref().as_array().is_none() => DVec3::splat(reader.real(table, "scale", 1.0)),
        _ => DVec3::from(reader.reals(table, "scale", [1.0; 3])),
    };
    DMat4::from_translation(translate) * DMat4::from_quat(rotation) * DMat4::from_scale(scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    #[test]
    fn the_camera_sees_its_target_in_the_middle() {
        let view = look_at(DVec3::new(0.0, 2.0, 5.0), DVec3::new(0.0, 2.0, 0.0), DVec3::Y);
        let clip = perspective(1.0, 1.5, 0.5, 20.0) * view * DVec4::new(0.0, 2.0, 0.0, 1.0);
        assert!(clip.x.abs() < 1e-15 && clip.y.abs() < 1e-15);
        assert!((clip.w - 5.0).abs() < 1e-15);
    }

    #[test]
    fn near_and_far_are_the_ends_of_clip_space() {
        let near = perspective(1.0, 1.0, 0.5, 20.0) * DVec4::new(0.0, 0.0, -0.5, 1.0);
        let far = perspective(1.0, 1.0, 0.5, 20.0) * DVec4::new(0.0, 0.0, -20.0, 1.0);
        assert!((near.z / near.w + 1.0).abs() < 1e-14);
        assert!((far.z / far.w - 1.0).abs() < 1e-14);
        let box_near = orthographic(2.0, 1.0, 0.5, 20.0) * DVec4::new(2.0, -1.0, -0.5, 1.0);
        assert!((box_near - DVec4::new(1.0, -1.0, -1.0, 1.0)).length() < 1e-14);
    }
}

//! Sets the state of the fixed-function pipeline by the functions of OpenGL 2.1, and its vertex arrays (OpenGL 2.1 §2.8,
//! §2.11 to §2.14, §3.10).
//!
//! *In:* the state of a draw, and the data of the attributes `gl_Vertex`, `gl_Normal` and so on. *Out:* a context from
//! which programs read it under its own names. *Holds:* positions and planes are in eye space, so that they are set under the
//! identity. What OpenGL derives, the driver derives.

use super::Error;
use super::api::Api;
use super::old::Old;
use super::pipeline;
use glisten_front::link::Program;
use glisten_scene::fixed::{FixedFunction, LightSource, Material, Pipeline};
use glisten_scene::{AttributeData, AttributeValues, FixedDraw};

const MODEL_VIEW: u32 = 0x1700;
const PROJECTION: u32 = 0x1701;
const TEXTURE: u32 = 0x1702;
const LIGHT0: u32 = 0x4000;
const LIGHT_MODEL_AMBIENT: u32 = 0x0B53;
const SHININESS: u32 = 0x1601;
const CLIP_PLANE0: u32 = 0x3000;
const TEXTURE_ENV: u32 = 0x2300;
const TEXTURE_ENV_COLOR: u32 = 0x2201;
const S: u32 = 0x2000;
const OBJECT_PLANE: u32 = 0x2501;
const EYE_PLANE: u32 = 0x2502;
const CLAMP_VERTEX_COLOR: u32 = 0x891A;
const FLAT: u32 = 0x1D00;
const SMOOTH: u32 = 0x1D01;
const VERTEX_PROGRAM_TWO_SIDE: u32 = 0x8643;
const POINT_SPRITE: u32 = 0x8861;
const VERTEX_ARRAY: u32 = 0x8074;
const NORMAL_ARRAY: u32 = 0x8075;
const COLOR_ARRAY: u32 = 0x8076;
const COORDINATE_ARRAY: u32 = 0x8078;
const FOG_ARRAY: u32 = 0x8457;
const SECONDARY_ARRAY: u32 = 0x845E;

/// Whether a program names the fixed-function pipeline, which only a compatibility context has.
pub(super) fn needs_compatibility(program: &Program) -> bool {
    program.stages.iter().flat_map(|shader| &shader.globals).any(|global| global.is_fixed())
}

/// Sets the state.
pub(super) fn set(api: &Api, old: &Old, draw: &FixedDraw) -> Result<(), Error> {
    let state = &draw.state;
    let identity = FixedFunction::default();
    matrix(old, MODEL_VIEW, &identity.model_view.to_cols_array());
    state.lights.iter().zip(LIGHT0..).for_each(|(light, number)| set_light(old, number, light));
    set_material(old, glow::FRONT, &state.front);
    set_material(old, glow::BACK, &state.back);
    (old.light_model)(LIGHT_MODEL_AMBIENT, &state.light_model_ambient.map(single));
    let fog = &state.fog;
    for (name, value) in [(0x0B62, fog.density), (0x0B63, fog.start), (0x0B64, fog.end)] {
        (old.fog)(name, &[single(value); 4]);
    }
    (old.fog)(0x0B66, &fog.color.map(single));
    for (plane, number) in state.clip_planes.iter().zip(CLIP_PLANE0..) {
        (old.clip_plane)(number, plane);
    }
    set_points(old, state);
    set_units(api, old, state);
    matrix(old, PROJECTION, &state.projection.to_cols_array());
    matrix(old, MODEL_VIEW, &state.model_view.to_cols_array());
    let clamp = if draw.switches.unclamped_colors { 0 } else { 1 };
    (old.clamp_color)(CLAMP_VERTEX_COLOR, clamp);
    (old.shade_model)(if draw.switches.flat_colors { FLAT } else { SMOOTH });
    if draw.switches.two_side {
        api.enable(VERTEX_PROGRAM_TWO_SIDE);
    } else {
        api.disable(VERTEX_PROGRAM_TWO_SIDE);
    }
    let own = Pipeline::default();
    pipeline::set(api, old, draw.generated.as_ref().map_or(&own, |(_, pipeline)| pipeline));
    // As in a core context, `gl_PointCoord` is there.
    api.enable(POINT_SPRITE);
    api.check("setting the state of the fixed-function pipeline")
}

fn single(value: f64) -> f32 {
    value as f32
}

fn matrix(old: &Old, mode: u32, columns: &[f64; 16]) {
    (old.matrix_mode)(mode);
    (old.load_matrix)(&columns.map(single));
}

fn set_light(old: &Old, number: u32, light: &LightSource) {
    let [x, y, z] = light.spot_direction;
    let colors = [light.ambient, light.diffuse, light.specular, light.position, [x, y, z, 0.0]];
    for (name, values) in (0x1200..).zip(colors) {
        (old.light)(number, name, &values.map(single));
    }
    let [constant, linear, quadratic] = light.attenuation;
    let numbers = [light.spot_exponent, light.spot_cutoff, constant, linear, quadratic];
    for (name, value) in (0x1205..).zip(numbers) {
        (old.light)(number, name, &[single(value); 4]);
    }
}

fn set_material(old: &Old, side: u32, material: &Material) {
    let colors = [
        (0x1200, material.ambient),
        (0x1201, material.diffuse),
        (0x1202, material.specular),
        (0x1600, material.emission),
    ];
    for (name, color) in colors {
        (old.material)(side, name, &color.map(single));
    }
    (old.material)(side, SHININESS, &[single(material.shininess); 4]);
}

fn set_points(old: &Old, state: &FixedFunction) {
    let point = &state.point;
    (old.point_size)(single(point.size));
    for (name, value) in [(0x8126, point.size_min), (0x8127, point.size_max), (0x8128, point.fade_threshold)] {
        (old.point_parameter)(name, &[single(value); 4]);
    }
    let [constant, linear, quadratic] = point.attenuation.map(single);
    (old.point_parameter)(0x8129, &[constant, linear, quadratic, 0.0]);
}

/// The matrices, environment colors and planes of the texture units.
fn set_units(api: &Api, old: &Old, state: &FixedFunction) {
    for (index, unit) in (glow::TEXTURE0..).take(state.texture.len()).enumerate() {
        api.active_texture(unit);
        if let Some(own) = state.texture.get(index) {
            matrix(old, TEXTURE, &own.to_cols_array());
        }
        if let Some(color) = state.texture_env_colors.get(index) {
            (old.texture_environment)(TEXTURE_ENV, TEXTURE_ENV_COLOR, &color.map(single));
        }
        for (kind, planes) in [(OBJECT_PLANE, &state.object_planes), (EYE_PLANE, &state.eye_planes)] {
            for (axis, planes) in (S..).zip(planes) {
                if let Some(plane) = planes.get(index) {
                    (old.texture_generation)(axis, kind, &plane.map(single));
                }
            }
        }
    }
    api.active_texture(glow::TEXTURE0);
}

/// Feeds an attribute of the fixed-function pipeline from the bound buffer, or from its only row.
pub(super) fn feed(old: &Old, name: &str, data: &AttributeData) -> Result<(), Error> {
    let AttributeValues::Float(values) = &data.values else {
        return Err(Error::Refused(format!("`{name}` has integers")));
    };
    let unit = name.strip_prefix("gl_MultiTexCoord").and_then(|unit| unit.parse::<u32>().ok()).unwrap_or(0);
    if data.divisor > 0 {
        if values.len() != data.size as usize {
            return Err(Error::Unsupported(format!("`{name}` an instance")));
        }
        current(old, name, unit, values);
        return Ok(());
    }
    let (size, stride) = (data.size as i32, data.size as i32 * 4);
    let array = match name {
        "gl_Vertex" => {
            (old.vertex_pointer)(size, glow::FLOAT, stride, 0);
            VERTEX_ARRAY
        }
        "gl_Normal" => {
            (old.normal_pointer)(glow::FLOAT, stride, 0);
            NORMAL_ARRAY
        }
        "gl_Color" => {
            (old.color_pointer)(size, glow::FLOAT, stride, 0);
            COLOR_ARRAY
        }
        "gl_SecondaryColor" => {
            (old.secondary_pointer)(size.min(3), glow::FLOAT, stride, 0);
            SECONDARY_ARRAY
        }
        "gl_FogCoord" => {
            (old.fog_pointer)(glow::FLOAT, stride, 0);
            FOG_ARRAY
        }
        _ => {
            (old.client_unit)(glow::TEXTURE0 + unit);
            (old.coordinate_pointer)(size, glow::FLOAT, stride, 0);
            COORDINATE_ARRAY
        }
    };
    (old.enable_array)(array);
    Ok(())
}

/// Sets the current value, which all vertices have.
fn current(old: &Old, name: &str, unit: u32, values: &[f32]) {
    let value = std::array::from_fn(|index| values.get(index).copied().unwrap_or(if index == 3 { 1.0 } else { 0.0 }));
    match name {
        "gl_Normal" => (old.normal)(&value),
        "gl_Color" => (old.color)(&value),
        "gl_SecondaryColor" => (old.secondary_color)(&value),
        "gl_FogCoord" => (old.fog_coordinate)(&value),
        _ => (old.coordinate)(glow::TEXTURE0 + unit, &value),
    }
}

/// The data with as many components as an array of OpenGL 2.1 may have, of which some attributes must have more than one.
pub(super) fn widened(name: &str, data: &AttributeData) -> Option<AttributeData> {
    let least = match name {
        "gl_Vertex" => 2,
        "gl_Normal" | "gl_Color" | "gl_SecondaryColor" => 3,
        _ => 1,
    };
    let AttributeValues::Float(values) = &data.values else { return None };
    if data.size >= least || data.divisor > 0 {
        return None;
    }
    let row = |row: &[f32]| {
        let given = row.to_vec();
        (0..least as usize).map(|index| given.get(index).copied().unwrap_or(0.0)).collect::<Vec<f32>>()
    };
    let values = values.chunks(data.size.max(1) as usize).flat_map(row).collect();
    Some(AttributeData { size: least, divisor: 0, values: AttributeValues::Float(values) })
}

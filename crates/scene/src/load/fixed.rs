//! The fixed-function pipeline in scenes: its state from `[camera]`, `[draw.transform]`, `[[light]]` and `[material]`,
//! and the switches of a draw.
//!
//! *In:* the scene's and the draw's tables. *Out:* a [`FixedFunction`], the options of the compiler, and the
//! [`Pipeline`] of a draw that names only one stage. *Holds:* lights are in eye space, as `glLightfv` puts them there
//! (OpenGL 2.1 §2.14.1).

use super::combine;
use super::lights::{Lighting, opaque};
use super::material::Colors;
use super::matrices::View;
use crate::fixed::{
    ColorMaterial, Combine, EnvironmentMode, FixedFunction, FogMode, FogSource, Material, NormalScaling, Pipeline,
    TexGen, TextureTarget, TextureUnit, UNITS,
};
use crate::tables::{Node, Reader};
use glisten_front::diagnostic::codes::scenes::{SCENE_WRONG_SIZE, SCENE_WRONG_VALUE};
use glisten_front::link::FixedState;
use toml::de::DeTable;

const KEYS: &[&str] = &[
    "lighting",
    "local_viewer",
    "separate_specular",
    "color_material",
    "normals",
    "color_sum",
    "fog",
    "fog_source",
    "point_attenuation",
    "units",
];

const UNIT_KEYS: &[&str] = &["target", "mode", "generate"];
const NO_TEXTURE: &str = "this unit has no texture";

/// The name of the generated stage in diagnostics.
pub(super) const GENERATED: &str = "<fixed-function>";

/// The switches of a draw that change what a program of that time does.
pub(super) fn load_switches(reader: &mut Reader, draw: &DeTable<'_>) -> FixedState {
    FixedState {
        two_side: reader.flag(draw, "vertex_program_two_side", false),
        clip_planes: reader.count(draw, "clip_distances", 0, 0..=UNITS as u32),
        unclamped_colors: !reader.flag(draw, "clamp_vertex_color", true),
        ..FixedState::default()
    }
}

/// The state of a draw before its own uniforms.
pub(super) fn state(view: &View, lighting: &Lighting, material: Option<&Colors>) -> FixedFunction {
    let mut state =
        FixedFunction { model_view: view.model_view(), projection: view.projection(), ..FixedFunction::default() };
    if !lighting.lights.is_empty() {
        state.light_model_ambient = opaque(lighting.global_ambient);
    }
    for (light, given) in state.lights.iter_mut().zip(&lighting.lights) {
        *light = given.source(view.view_matrix());
    }
    if let Some(colors) = material {
        let material = Material {
            emission: opaque(colors.emission),
            ambient: opaque(colors.ambient),
            diffuse: opaque(colors.diffuse),
            specular: opaque(colors.specular),
            shininess: colors.shininess,
        };
        (state.front, state.back) = (material, material);
    }
    state
}

/// The pipeline whose other stage completes a draw that names only one.
pub(super) fn load_pipeline(reader: &mut Reader, draw: &DeTable<'_>, lights: usize, switches: FixedState) -> Pipeline {
    let empty = DeTable::new();
    let table = reader.table_at(draw, "fixed_function").unwrap_or(&empty);
    reader.check_keys(table, "`fixed_function`", KEYS);
    let lighting = reader.flag(table, "lighting", lights > 0);
    Pipeline {
        lighting,
        lights: std::array::from_fn(|index| lighting && index < lights.max(1)),
        local_viewer: reader.flag(table, "local_viewer", false),
        two_side: switches.two_side,
        separate_specular: reader.flag(table, "separate_specular", false),
        color_material: reader.choice_at(table, "color_material", None, ColorMaterial::NAMES),
        normals: reader.choice_at(table, "normals", NormalScaling::None, NormalScaling::NAMES),
        units: load_units(reader, draw, table),
        color_sum: reader.flag(table, "color_sum", false),
        fog: reader.choice_at(table, "fog", None, FogMode::NAMES),
        fog_source: reader.choice_at(table, "fog_source", FogSource::Depth, FogSource::NAMES),
        point_attenuation: reader.flag(table, "point_attenuation", false),
        clip: switches.clip_planes > 0,
        ..Pipeline::default()
    }
}

/// The units of `units`, and those whose texture `[draw.textures]` has.
fn load_units(reader: &mut Reader, draw: &DeTable<'_>, table: &DeTable<'_>) -> [Option<TextureUnit>; UNITS] {
    let textures = draw.get("textures").and_then(|node| node.get_ref().as_table());
    let mut units: [Option<TextureUnit>; UNITS] = std::array::from_fn(|index| {
        let name = format!("texture{index}");
        let texture = textures?.iter().find(|(key, _)| key.get_ref().as_ref() == name)?.1;
        let kind = texture.get_ref().as_table().and_then(|table| table.get("kind"));
        let kind = kind.and_then(|kind| kind.get_ref().as_str());
        let target = TextureTarget::NAMES.iter().find(|(name, _)| Some(*name) == kind);
        Some(TextureUnit { target: target.map_or(TextureTarget::D2, |row| row.1), ..TextureUnit::default() })
    });
    let Some(node) = table.get("units") else { return units };
    let Some(list) = node.get_ref().as_array() else {
        reader.wrong_type(node, "units", "a list of tables, one for each texture unit");
        return units;
    };
    if list.len() > UNITS {
        let span = reader.span_of(node);
        let message = format!("there are {UNITS} texture units, and here are {}", list.len());
        reader.error(&SCENE_WRONG_SIZE, span, message, "too many");
    }
    for (slot, node) in units.iter_mut().zip(list.iter()) {
        *slot = load_unit(reader, node, slot.unwrap_or_default());
    }
    for (slot, node) in units.iter().zip(list.iter()) {
        let absent = |unit: &u8| !units.get(usize::from(*unit)).is_some_and(Option::is_some);
        if let Some(unit) = slot.iter().flat_map(TextureUnit::others).find(absent) {
            let span = reader.span_of(node);
            reader.error(&SCENE_WRONG_VALUE, span, format!("the combiner reads `texture{unit}`"), NO_TEXTURE);
        }
    }
    units
}

fn load_unit(reader: &mut Reader, node: &Node<'_>, known: TextureUnit) -> Option<TextureUnit> {
    let table = reader.table(node, "units")?;
    let mode = reader.choice_at(table, "mode", EnvironmentMode::Modulate, EnvironmentMode::NAMES);
    let combines = mode == EnvironmentMode::Combine;
    let keys = if combines { [UNIT_KEYS, combine::KEYS].concat() } else { UNIT_KEYS.to_vec() };
    reader.check_keys(table, "a texture unit", &keys);
    Some(TextureUnit {
        target: reader.choice_at(table, "target", known.target, TextureTarget::NAMES),
        mode,
        combine: if combines { combine::load(reader, table) } else { Combine::default() },
        generate: reader.choice_at(table, "generate", None, TexGen::NAMES),
    })
}

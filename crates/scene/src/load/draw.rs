//! Loads a `[[draw]]` table as a [`Draw`].

use super::attributes::{load_attributes, scalar_of};
use super::depths::{self, Caster};
use super::fixed::{self, GENERATED, load_pipeline, load_switches};
use super::lights::{LIGHT_SPACES, LightSpace};
use super::material::{load_colors, load_material, macros};
use super::matrices::View;
use super::mesh::{Mesh, load_mesh};
use super::names::{BLENDS, CULLS, FRONT_FACES, PRIMITIVES, PROVOKING};
use super::sources::load_sources;
use super::textures::load_textures;
use super::uniforms::{Context, load_uniforms};
use super::{Loader, ProgramKey, Surroundings, library_file};
use crate::dynamic::is_known;
use crate::fixed::{FixedFunction, OtherStage, other_stage, uses_fixed_state};
use crate::model::{
    AttributeData, Blend, BlendFactor, Compare, Cull, Draw, FixedDraw, Format, Framebuffer, Primitive, State,
};
use crate::tables::{Node, NumberValue, Reader, report_unknown_name};
use glisten_front::diagnostic::codes::scenes::{
    OUTPUT_WITHOUT_ATTACHMENT, SCENE_CANNOT_DRAW, SCENE_WRONG_SIZE, SCENE_WRONG_TYPE, SCENE_WRONG_VALUE,
};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::hir::{Global, Scalar, Shader, Stage};
use glisten_front::link::{FixedState, Program};
use glisten_front::source::Span;
use std::collections::BTreeSet;
use std::sync::Arc;
use toml::de::DeTable;

const KEYS: &[&str] = &[
    "program",
    "vertex",
    "geometry",
    "fragment",
    "defines",
    "engine",
    "assume_version",
    "include_style",
    "includes",
    "preludes",
    "primitive",
    "cull",
    "depth_test",
    "dynamic",
    "attributes",
    "attribute_locations",
    "frag_data_locations",
    "uniforms",
    "textures",
    "vertex_count",
    "indices",
    "instances",
    "front_face",
    "provoking",
    "clip_distances",
    "program_point_size",
    "depth_write",
    "depth_func",
    "blend",
    "blend_color",
    "mesh",
    "camera",
    "transform",
    "matrices",
    "material",
    "light_space",
    "vertex_program_two_side",
    "clamp_vertex_color",
    "fixed_function",
];

/// The largest number of vertices or indices of a draw, and of instances.
const MAX_COUNT: u32 = 1 << 22;

pub(super) fn load_draw(loader: &mut Loader<'_>, node: &Node<'_>, around: &Surroundings<'_, '_>) -> Option<Draw> {
    let framebuffer = &around.framebuffer;
    let table = loader.reader.table(node, "draw")?;
    loader.reader.check_keys(table, "a draw", KEYS);
    // The header only, so that an excerpt does not show the whole table.
    let place = loader.reader.span(node.span());
    let state = load_state(&mut loader.reader, table);
    let switches = load_switches(&mut loader.reader, table);
    let (files, generated) = load_stages(loader, table, place, (around, switches));
    let conventional = files.iter().any(|(_, name, _)| library_file(name).is_some());
    let mut mesh = table.get("mesh").map(|node| load_mesh(loader, node, conventional));
    let program = load_program(loader, table, files, around, (switches, generated.as_ref()))?;
    if let Some(Some(mesh)) = &mut mesh {
        let given = table.get("attributes").and_then(|node| node.get_ref().as_table());
        mesh.complete_tangents(&program, &|name| given.is_some_and(|given| given.contains_key(name)));
    }
    let possible = check_program(&mut loader.reader, &program, framebuffer, place)
        .and_then(|()| check_primitive(&mut loader.reader, table, &program, &state, place));
    let view = View::load(&mut loader.reader, table, around.camera, framebuffer);
    let material = load_material(&mut loader.reader, table, around.material, &program);
    let library = loader.library;
    // What a geometry stage emits is its own affair.
    let may_be_points = state.primitive == Primitive::Points || program.stage(Stage::Geometry).is_some();
    let sizes_points = state.program_point_size && may_be_points;
    let reaching = || library.attributes_that_reach(&program, sizes_points);
    let instances = loader.reader.count(table, "instances", 1, 0..=MAX_COUNT);
    let given_mesh = mesh.as_ref().map(Option::as_ref);
    let attributes = load_attributes(&mut loader.reader, table, &program, given_mesh, (place, &reaching, instances));
    let space = loader.reader.choice_at(table, "light_space", LightSpace::World, LIGHT_SPACES);
    let is_seen = around.camera.is_some() || table.contains_key("camera") || table.contains_key("mesh");
    let maps = depths::load_maps(&mut loader.reader, table);
    let lighting = &around.lighting;
    let harmonics = around.harmonics.as_ref();
    let context =
        Context { program: &program, view: &view, lighting, harmonics, space, conventional, is_seen, maps: &maps };
    let mut fixed = load_fixed(&mut loader.reader, table, (&program, &view), around);
    let uniforms = load_uniforms(&mut loader.reader, table, &context, material.as_ref(), fixed.as_mut(), place);
    let generated = generated.map(|made| (made.stage, made.pipeline));
    let fixed = fixed.map(|state| Arc::new(FixedDraw { state, switches, generated }));
    let own_material = material.and_then(|(_, node)| node.get_ref().as_table());
    let textures =
        load_textures(loader, (table, own_material, around.environment), &program, (conventional, &maps), place);
    let dynamic = load_dynamic(&mut loader.reader, table, &program);
    // Whatever else is wrong was reported before a mesh or a program that cannot be drawn with ends the draw.
    possible?;
    let mut mesh = match mesh {
        Some(mesh) => Some(mesh?),
        None => None,
    };
    loader.casters.push(mesh.as_ref().map(|mesh| Caster::new(mesh, view.model(), state.primitive)));
    if let Some(mesh) = mesh.as_mut().filter(|_| state.primitive == Primitive::TrianglesAdjacency) {
        mesh.geometry.indices = mesh.geometry.with_adjacency();
    }
    let (vertex_count, indices) = load_counts(loader, table, mesh.as_ref(), &program, &attributes, instances, place)?;
    Some(Draw { program, state, vertex_count, indices, instances, attributes, uniforms, textures, dynamic, fixed })
}

/// The state of the fixed-function pipeline, if the program has anything of it.
fn load_fixed(
    reader: &mut Reader,
    table: &DeTable<'_>,
    (program, view): (&Program, &View),
    around: &Surroundings<'_, '_>,
) -> Option<FixedFunction> {
    let has = |shader: &Shader| shader.globals.iter().any(Global::is_fixed);
    if !uses_fixed_state(program) && !program.stages.iter().any(has) {
        return None;
    }
    let colors = load_colors(reader, table, around.material, program);
    Some(fixed::state(view, &around.lighting, colors.as_ref()))
}

/// The stages of a draw. If it names only one, and that is of a language with the fixed-function pipeline, the text of the
/// other one is generated.
fn load_stages(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    place: Span,
    (around, switches): (&Surroundings<'_, '_>, FixedState),
) -> (Vec<(Stage, String, Span)>, Option<OtherStage>) {
    let named = |key: &str| table.contains_key(key);
    let alone = !named("program") && named("vertex") != named("fragment");
    let one = if alone { loader.lone_stage(table) } else { None };
    let Some((types, shader, file)) = one else {
        refuse_pipeline(&mut loader.reader, table);
        return (load_files(loader, table, place), None);
    };
    let pipeline = load_pipeline(&mut loader.reader, table, around.lighting.lights.len(), switches);
    let made = other_stage(pipeline, &types, &shader);
    let other = (made.stage, GENERATED.to_owned(), file.2);
    let files = if made.stage == Stage::Vertex { vec![other, file] } else { vec![file, other] };
    (files, Some(made))
}

/// Reports switches of the fixed-function pipeline in a draw that does not use it.
fn refuse_pipeline(reader: &mut Reader, table: &DeTable<'_>) {
    if let Some((key, _)) = table.get_key_value("fixed_function") {
        let span = reader.span_of(key);
        let message = "the fixed-function pipeline is for a draw with one stage in GLSL 1.10 to 1.30 or the compatibility profile";
        reader.error(&SCENE_WRONG_VALUE, span, message.to_owned(), "it changes nothing here");
    }
}

fn load_state(reader: &mut Reader, table: &DeTable<'_>) -> State {
    State {
        primitive: reader.choice_at(table, "primitive", Primitive::Triangles, PRIMITIVES),
        cull: reader.choice_at(table, "cull", Cull::None, CULLS),
        front_ccw: reader.choice_at(table, "front_face", true, FRONT_FACES),
        provoking_last: reader.choice_at(table, "provoking", true, PROVOKING),
        depth_test: reader.flag(table, "depth_test", false),
        depth_write: reader.flag(table, "depth_write", true),
        depth_func: reader.choice_at(table, "depth_func", Compare::Less, Compare::NAMES),
        blend: load_blend(reader, table),
        clip_distances: reader.count(table, "clip_distances", 0, 0..=8),
        program_point_size: reader.flag(table, "program_point_size", false),
    }
}

/// How colors are blended, with the constant color.
fn load_blend(reader: &mut Reader, table: &DeTable<'_>) -> Option<Blend> {
    let blend = load_factors(reader, table);
    let constant = reader.reals(table, "blend_color", [0.0; 4]).map(|channel| channel as f32);
    let factors = blend.iter().flat_map(|blend| [blend.source, blend.destination]).collect::<Vec<_>>();
    let by_color = factors.iter().any(|factor| factor.reads_constant_color());
    let by_alpha = factors.iter().any(|factor| factor.reads_constant_alpha());
    if let Some(node) = table.get("blend_color") {
        let span = reader.span_of(node);
        if !constant.iter().all(|channel| (0.0..=1.0).contains(channel)) {
            reader.wrong_value(span, "`blend_color` has numbers from 0 to 1", "OpenGL clamps the others");
        } else if !by_color && !by_alpha {
            reader.wrong_value(span, "no factor of `blend` reads `blend_color`", "it changes nothing");
        }
    }
    if let (Some(node), true, true) = (table.get("blend"), by_color, by_alpha) {
        let span = reader.span_of(node);
        let message = "no draw has factors of the constant color and of the constant alpha";
        reader.wrong_value(span, message, "WebGL and WebGPU have one of the two");
    }
    blend.map(|blend| Blend { constant, ..blend })
}

fn load_factors(reader: &mut Reader, table: &DeTable<'_>) -> Option<Blend> {
    let node = table.get("blend")?;
    let Some(pair) = node.get_ref().as_array() else {
        return reader.choice(node, "blend", BLENDS).flatten();
    };
    let mut factors = pair.iter().map(|factor| reader.choice(factor, "blend", BlendFactor::NAMES));
    match (factors.next(), factors.next(), factors.next()) {
        (Some(source), Some(destination), None) => Some(Blend::new(source?, destination?)),
        _ => {
            drop(factors);
            reader.wrong_type(node, "blend", "a name or a pair of factors");
            None
        }
    }
}

/// The shaders of a draw: stage, name, span of the name. None if one is missing (reported).
fn load_files(loader: &mut Loader<'_>, table: &DeTable<'_>, place: Span) -> Vec<(Stage, String, Span)> {
    let stages = [("vertex", Stage::Vertex), ("geometry", Stage::Geometry), ("fragment", Stage::Fragment)];
    let Some(node) = table.get("program") else {
        let mut files = Vec::new();
        for (key, stage) in stages {
            let Some(node) = table.get(key) else {
                if stage == Stage::Geometry || loader.reader.is_misspelled(table, key) {
                    continue;
                }
                let message = format!("a draw names its {key} shader");
                let help = format!("add `{key} = \"...\"`, relative to the scene file, or `program = \"...\"`");
                loader.missing_key(place, &message, &help);
                continue;
            };
            if let Some(name) = loader.reader.text(node, key)
                && is_of_stage(&mut loader.reader, node, (key, stage), name)
            {
                files.push((stage, name.to_owned(), loader.reader.span_of(node)));
            }
        }
        let has = |wanted: Stage| files.iter().any(|(stage, _, _)| *stage == wanted);
        let complete =
            has(Stage::Vertex) && has(Stage::Fragment) && has(Stage::Geometry) == table.get("geometry").is_some();
        return if complete { files } else { Vec::new() };
    };
    if let Some((key, _)) = stages.iter().find_map(|(key, _)| table.get_key_value(*key)) {
        let span = loader.reader.span_of(key);
        let message = format!("a draw with a `program` of the library has no `{}`", key.get_ref());
        loader.reader.error(&SCENE_WRONG_VALUE, span, message, "leave one of the two out");
        return Vec::new();
    }
    let Some(name) = loader.reader.text(node, "program") else { return Vec::new() };
    let span = loader.reader.span_of(node);
    let Some((vertex, fragment)) = loader.library.program(name) else {
        let near = did_you_mean(name, loader.library.program_names());
        let help = near.map(|near| format!("did you mean `{near}`?"));
        let message = format!("the library has no program `{name}`");
        let diagnostic = Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here("no such program");
        loader.reader.report(diagnostic.maybe_help(help));
        return Vec::new();
    };
    let file = |name: &str| format!("<glisten/programs/{name}>");
    vec![(Stage::Vertex, file(vertex), span), (Stage::Fragment, file(fragment), span)]
}

/// How the names of files end that tell their stage.
const EXTENSIONS: &[(&str, Stage)] = &[
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("glslv", Stage::Vertex),
    ("geom", Stage::Geometry),
    ("gs", Stage::Geometry),
    ("gsh", Stage::Geometry),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
    ("glslf", Stage::Fragment),
];

/// Whether a file may be of the stage that its key says. Reports one whose name says another.
fn is_of_stage(reader: &mut Reader, node: &Node<'_>, (key, stage): (&str, Stage), name: &str) -> bool {
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    let told = EXTENSIONS.iter().find(|row| row.0.eq_ignore_ascii_case(extension)).map(|row| row.1);
    let Some(other) = told.filter(|told| *told != stage) else { return true };
    let span = reader.span_of(node);
    let message = format!("`{key}` names the {} shader `{name}`", other.name());
    let finding = Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here(format!("not a {} shader", stage.name()));
    reader.report(finding.help(format!("write it under `{}`", other.name())));
    false
}

/// `[draw.defines]`: macros of the draw's program.
pub(super) fn load_defines(reader: &mut Reader, table: &DeTable<'_>) -> Vec<(String, String)> {
    let Some(defines) = reader.table_at(table, "defines") else { return Vec::new() };
    let mut list = Vec::new();
    for (name, node) in defines {
        let Some(name) = reader.macro_name(name) else { continue };
        list.extend(reader.macro_text(node, &name, ["false", "true"]).map(|value| (name, value)));
    }
    list
}

fn load_program(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    files: Vec<(Stage, String, Span)>,
    around: &Surroundings<'_, '_>,
    (switches, generated): (FixedState, Option<&OtherStage>),
) -> Option<Arc<Program>> {
    let attribute_locations = load_locations(&mut loader.reader, table, "attribute_locations");
    let frag_data_locations = load_locations(&mut loader.reader, table, "frag_data_locations");
    let mut defines = load_defines(&mut loader.reader, table);
    for (name, value) in own_macros(table, &files, around) {
        if defines.iter().all(|(known, _)| known != name) {
            defines.push((name.to_owned(), value));
        }
    }
    let sources = load_sources(loader, table)?;
    if files.is_empty() {
        return None;
    }
    let places: Vec<Span> = files.iter().map(|(_, _, span)| *span).collect();
    let program = loader.program(
        ProgramKey {
            files: files.into_iter().map(|(stage, name, _)| (stage, name)).collect(),
            defines,
            sources,
            switches,
            generated: generated.map(|made| made.text.clone()),
            attribute_locations: attribute_locations.iter().map(|(name, value, _)| (name.clone(), *value)).collect(),
            frag_data_locations: frag_data_locations.iter().map(|(name, value, _)| (name.clone(), *value)).collect(),
        },
        &places,
    )?;
    let attributes: Vec<&str> = program.interface.attributes.iter().map(|a| a.name.as_str()).collect();
    let outputs: Vec<&str> = program.interface.outputs.iter().map(|o| o.name.as_str()).collect();
    for (what, names, locations) in
        [("attribute", attributes, attribute_locations), ("output", outputs, frag_data_locations)]
    {
        for (name, _, span) in locations {
            if !names.contains(&name.as_str()) {
                report_unknown_name(&mut loader.reader, span, what, &name, &names);
            }
        }
    }
    Some(program)
}

/// The macros that programs of the library have for what the scene gives them.
fn own_macros(
    table: &DeTable<'_>,
    files: &[(Stage, String, Span)],
    around: &Surroundings<'_, '_>,
) -> Vec<(&'static str, String)> {
    if files.iter().all(|(_, name, _)| library_file(name).is_none()) {
        return Vec::new();
    }
    let is_standard = files.iter().any(|(_, name, _)| library_file(name) == Some("standard.frag"));
    let names = if is_standard { macros(table, around.material) } else { Vec::new() };
    let cones = around.lighting.has_cones().then_some("GLISTEN_CONES");
    let harmonics = around.harmonics.is_some();
    let standard = [
        ("GLISTEN_SURROUNDED", harmonics || around.environment.is_some()),
        ("GLISTEN_HARMONICS", harmonics),
        ("GLISTEN_AREAS", around.lighting.has_areas()),
    ];
    let standard = standard.into_iter().filter(|(_, wanted)| is_standard && *wanted).map(|(name, _)| name);
    let flags = names.into_iter().chain(cones).chain(standard).map(|name| (name, "1".to_owned()));
    flags.chain(around.lighting.room().map(|room| ("GLISTEN_LIGHTS", room.to_string()))).collect()
}

fn load_locations(reader: &mut Reader, table: &DeTable<'_>, key: &str) -> Vec<(String, u32, Span)> {
    let Some(locations) = reader.table_at(table, key) else { return Vec::new() };
    let mut list = Vec::new();
    for (name, node) in locations {
        let span = reader.span_of(name);
        if let Some(location) = reader.integer(node, name.get_ref(), 0..=i64::from(u16::MAX)) {
            list.push((name.get_ref().to_string(), location as u32, span));
        }
    }
    list
}

fn check_program(reader: &mut Reader, program: &Program, framebuffer: &Framebuffer, place: Span) -> Option<()> {
    for output in &program.interface.outputs {
        if output.location >= framebuffer.attachments {
            let message = format!(
                "output `{}` has color number {}, and the framebuffer has {} attachment{}",
                output.name,
                output.location,
                framebuffer.attachments,
                if framebuffer.attachments == 1 { "" } else { "s" }
            );
            let help = format!("write `attachments = {}` under [framebuffer]", output.location + 1);
            reader.report(
                Diagnostic::new(&OUTPUT_WITHOUT_ATTACHMENT, place, format!("{message}: it is dropped")).help(help),
            );
            continue;
        }
        let holds = match framebuffer.format {
            Format::Rgba32Sint => Scalar::Int,
            Format::Rgba32Uint => Scalar::Uint,
            Format::Rgba32Float | Format::Rgba16Float | Format::Rgba8Unorm => Scalar::Float,
        };
        let written = scalar_of(&program.types, output.ty);
        if written != holds {
            let message = format!(
                "output `{}` is {}, and the framebuffer holds {}",
                output.name,
                program.types.name(output.ty),
                holds.name()
            );
            let help = "the `format` under [framebuffer] and the type of the output must agree";
            reader.report(Diagnostic::new(&SCENE_CANNOT_DRAW, place, message).help(help));
            return None;
        }
    }
    Some(())
}

/// Reports a primitive that the geometry shader does not take (OpenGL 3.2 §2.12.1).
fn check_primitive(
    reader: &mut Reader,
    table: &DeTable<'_>,
    program: &Program,
    state: &State,
    place: Span,
) -> Option<()> {
    let Some(input) = program.stage(Stage::Geometry).and_then(|shader| shader.geometry.input) else { return Some(()) };
    if state.primitive.feeds(input) {
        return Some(());
    }
    let of = |list: &[(&'static str, Primitive)], wanted: &dyn Fn(Primitive) -> bool| -> Vec<&'static str> {
        list.iter().filter(|(_, primitive)| wanted(*primitive)).map(|(name, _)| *name).collect()
    };
    let drawn = of(PRIMITIVES, &|primitive| primitive == state.primitive).concat();
    let taken = of(PRIMITIVES, &|primitive| primitive.feeds(input));
    let span = table.get("primitive").map_or(place, |node| reader.span_of(node));
    let message = format!("the draw has `{drawn}`, and the geometry shader takes other primitives");
    let help = format!("`primitive` may be \"{}\" with this shader", taken.join("\", \""));
    reader.report(Diagnostic::new(&SCENE_CANNOT_DRAW, span, message).help(help));
    None
}

fn load_dynamic(reader: &mut Reader, table: &DeTable<'_>, program: &Program) -> Vec<String> {
    let Some(node) = table.get("dynamic") else { return Vec::new() };
    let Some(array) = node.get_ref().as_array() else {
        reader.wrong_type(node, "dynamic", "a list of uniform names");
        return Vec::new();
    };
    let interface = &program.interface;
    let mut candidates: Vec<&str> = interface.uniforms.iter().map(|leaf| leaf.name.as_str()).collect();
    candidates.extend(interface.roots.iter().map(|root| root.name.as_str()));
    candidates.extend(interface.samplers.iter().map(|sampler| sampler.name.as_str()));
    let mut listed = BTreeSet::new();
    candidates.retain(|name| listed.insert(*name));
    let mut names = Vec::new();
    for node in array {
        let Some(name) = reader.text(node, "dynamic") else { continue };
        let known = is_known(program, name) || candidates.contains(&name);
        if !known {
            let span = reader.span_of(node);
            report_unknown_name(reader, span, "uniform", name, &candidates);
        }
        names.push(name.to_owned());
    }
    names
}

/// The number of vertices or indices to draw, and the indices.
fn load_counts(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    mesh: Option<&Mesh>,
    program: &Program,
    attributes: &[Option<AttributeData>],
    instances: u32,
    place: Span,
) -> Option<(u32, Option<Vec<u32>>)> {
    let rows = check_rows(&mut loader.reader, program, attributes, instances, place)?;
    let given = table.get("vertex_count").map(|node| {
        let count = loader.reader.count(table, "vertex_count", 0, 0..=MAX_COUNT);
        (count, loader.reader.span_of(node))
    });
    if let (Some((count, span)), Some(rows)) = (given, rows)
        && count > rows
    {
        let message = format!("`vertex_count` is {count}, and there is data for {rows}");
        loader.reader.error(&SCENE_WRONG_SIZE, span, message, "more than there is");
        return None;
    }
    let vertices = given.map(|(count, _)| count).or(rows);
    match (mesh, table.get("indices"), vertices) {
        (Some(_), Some(node), _) => {
            let span = loader.reader.span_of(node);
            loader.reader.error(&SCENE_WRONG_VALUE, span, "a mesh brings its own indices".into(), "leave these out");
            None
        }
        (Some(mesh), None, _) => {
            check_mesh_indices(&mut loader.reader, mesh, given)?;
            Some((mesh.geometry.indices.len() as u32, Some(mesh.geometry.indices.clone())))
        }
        (None, Some(node), _) => {
            let indices = load_indices(&mut loader.reader, node, vertices)?;
            Some((indices.len() as u32, Some(indices)))
        }
        (None, None, Some(count)) => Some((count, None)),
        (None, None, None) => {
            // Where data is missing, that is the error.
            let message = "a draw without vertex data needs `vertex_count`";
            let help = "add `vertex_count = 3`: no attribute determines the number of vertices";
            if !lacks_data(program, attributes) && !loader.reader.is_misspelled(table, "vertex_count") {
                loader.missing_key(place, message, help);
            }
            None
        }
    }
}

/// Whether the vertex shader reads an attribute that got no data.
fn lacks_data(program: &Program, attributes: &[Option<AttributeData>]) -> bool {
    program.interface.attributes.iter().zip(attributes).any(|(attribute, data)| attribute.active && data.is_none())
}

/// Reports a `vertex_count` that leaves out vertices of the mesh.
fn check_mesh_indices(reader: &mut Reader, mesh: &Mesh, given: Option<(u32, Span)>) -> Option<()> {
    let needed = mesh.geometry.indices.iter().max().map_or(0, |last| last + 1);
    let Some((count, span)) = given.filter(|(count, _)| *count < needed) else { return Some(()) };
    let message = format!("`vertex_count` is {count}, and the mesh has {needed} vertices");
    reader.error(&SCENE_WRONG_SIZE, span, message, "a mesh determines this itself");
    None
}

/// The number of vertices for which there is data; the inner `None` if no attribute determines it.
fn check_rows(
    reader: &mut Reader,
    program: &Program,
    attributes: &[Option<AttributeData>],
    instances: u32,
    place: Span,
) -> Option<Option<u32>> {
    let mut rows: Option<(u32, &str)> = None;
    for (attribute, data) in program.interface.attributes.iter().zip(attributes) {
        let Some(data) = data else { continue };
        let count = data.values.len() as u32 / data.size.max(1);
        if data.divisor > 0 {
            let wanted = instances.div_ceil(data.divisor);
            if count < wanted {
                let message = format!("`{}` has data for {count} steps, and {wanted} are drawn", attribute.name);
                reader.error(&SCENE_WRONG_SIZE, place, message, "too few instances");
                return None;
            }
            continue;
        }
        match rows {
            Some((known, first)) if known != count => {
                let message = format!(
                    "`{first}` has data for {known} vertices, `{}` for {count}: all attributes need the same number",
                    attribute.name
                );
                reader.error(&SCENE_WRONG_SIZE, place, message, "in this draw");
                return None;
            }
            Some(_) => {}
            None => rows = Some((count, &attribute.name)),
        }
    }
    Some(rows.map(|(count, _)| count))
}

fn load_indices(reader: &mut Reader, node: &Node<'_>, rows: Option<u32>) -> Option<Vec<u32>> {
    let numbers = reader.numbers(node, "indices")?;
    let limit = rows.unwrap_or(MAX_COUNT);
    let mut indices = Vec::with_capacity(numbers.len());
    for number in numbers {
        let NumberValue::Int(value, _) = number.value else {
            reader.error(&SCENE_WRONG_TYPE, number.span, "an index is an integer".into(), "no integer");
            return None;
        };
        match u32::try_from(value) {
            Ok(index) if index < limit => indices.push(index),
            _ => {
                let message = match value {
                    ..0 => format!("index {value} is negative: the first vertex is 0"),
                    _ => format!("index {value} is past the last vertex, {}", i64::from(limit) - 1),
                };
                reader.error(&SCENE_WRONG_SIZE, number.span, message, "no such vertex");
                return None;
            }
        }
    }
    Some(indices)
}

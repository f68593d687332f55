//! [`scene`]: the text of a scene.
//!
//! *In:* what a program reads, a form, the names of its files. *Out:* TOML that loads without a diagnostic. *Holds:* only what the program
//! reads is in it.

use super::choice::{Choice, Taste};
use super::forms::{Form, Shape, View};
use super::meanings::{FAR, NEAR};
use super::reads::{Input, Reads, named_role, own_name, scalar_of};
use super::textures::{self, Needs};
use super::values::{CORNERS, Range, corner, identity, text_of, uniform_text};
use glisten_front::hir::{PrimitiveIn, Scalar, Stage, Type};
use glisten_front::link::{SamplerSlot, UniformLeaf};
use glisten_scene::roles::{AttributeRole, MatrixRole, is_plain_transform};
use glisten_scene::toml_string;
use std::fmt::Write;

/// The parts of a scene that do not follow from what the program reads.
pub(super) struct Head {
    /// The stages of the draw with the names of their files.
    pub(super) stages: Vec<(Stage, String)>,
    /// Lines for the draw: how its sources are completed.
    pub(super) sources: String,
}

/// The camera of [`View::Camera`].
const EYE: &str = "[0.0, 1.5, 2.6]";
/// The distance from which the square of -1 to 1 fills the window: 1 / tan(45 / 2 degrees).
const FRONT: &str = "[0.0, 0.0, 2.41421]";
/// The largest number of elements of an array of matrices that get a line each.
const MAX_ELEMENTS: u32 = 8;
/// Roles that a mesh has data for.
const MESH_ROLES: [AttributeRole; 3] = [AttributeRole::Position, AttributeRole::Normal, AttributeRole::Texcoord];

/// The text of a scene.
pub(super) fn scene(reads: &Reads<'_>, head: &Head, choice: &Choice) -> String {
    let mut text = String::new();
    if reads.fixed.lights {
        text.push_str("global_ambient = [0.2, 0.2, 0.2]\n\n");
    }
    framebuffer(&mut text, reads, choice.side);
    camera(&mut text, reads, &choice.form);
    lights(&mut text, reads);
    draw(&mut text, reads, head, &choice.form);
    attributes(&mut text, reads, choice);
    let (matrices, numbers) = uniforms(reads, choice);
    table(&mut text, "[draw.matrices]   # by the camera", &matrices);
    table(&mut text, "[draw.uniforms]   # matrices by columns", &numbers);
    if reads.passes("gl_TexCoord") && !reads.passes("gl_FrontColor") {
        text.push_str("\n[draw.fixed_function]\nunits = [{ mode = \"replace\" }]   # the program passes no color\n");
    }
    table(&mut text, "[draw.textures]   # or { file = \"image.png\" }", &samplers(reads, choice.taste));
    text
}

/// A key of TOML: bare if it may be.
fn key(name: &str) -> String {
    let is_bare = name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if is_bare && !name.is_empty() { name.to_owned() } else { toml_string(name) }
}

fn table(text: &mut String, header: &str, lines: &[String]) {
    if !lines.is_empty() {
        let _ = writeln!(text, "\n{header}\n{}", lines.join("\n"));
    }
}

fn framebuffer(text: &mut String, reads: &Reads<'_>, side: u32) {
    let clear = if reads.is_shown_by_alpha() { "0.1, 0.2, 0.4" } else { "0.0, 0.0, 0.0" };
    let _ = writeln!(text, "[framebuffer]\nwidth = {side}\nheight = {side}\nclear = [{clear}, 1.0]");
    let outputs = &reads.program.interface.outputs;
    let format = outputs.first().and_then(|output| scalar_of(&reads.program.types, output.ty));
    match format {
        Some(Scalar::Int) => text.push_str("format = \"rgba32sint\"\n"),
        Some(Scalar::Uint) => text.push_str("format = \"rgba32uint\"\n"),
        Some(Scalar::Float | Scalar::Bool) | None => {}
    }
    let attachments = outputs.iter().map(|output| output.location + 1).max().unwrap_or(1);
    if attachments > 1 {
        let _ = writeln!(text, "attachments = {attachments}");
    }
}

fn camera(text: &mut String, reads: &Reads<'_>, form: &Form) {
    let eye = match form {
        Form::Mesh(_, View::Camera) | Form::Square(_, _, View::Camera) => EYE,
        Form::Mesh(_, View::Front) | Form::Square(_, _, View::Front) => FRONT,
        _ => return,
    };
    if reads.has_matrices() {
        let _ = writeln!(
            text,
            "\n[camera]\neye = {eye}\ntarget = [0.0, 0.0, 0.0]\nfovy = 45\nnear = {NEAR:?}\nfar = {FAR:?}"
        );
    }
}

fn lights(text: &mut String, reads: &Reads<'_>) {
    if reads.fixed.lights {
        text.push_str("\n[[light]]\nkind = \"point\"\nposition = [2.0, 3.0, 4.0]\n");
    }
    if reads.fixed.material {
        text.push_str("\n[material]\nambient = [0.2, 0.2, 0.2]\ndiffuse = [0.8, 0.8, 0.8]\nspecular = [0.5, 0.5, 0.5]\nshininess = 32\n");
    }
}

fn draw(text: &mut String, reads: &Reads<'_>, head: &Head, form: &Form) {
    text.push_str("\n[[draw]]\n");
    for (stage, name) in &head.stages {
        let key = match stage {
            Stage::Vertex => "vertex",
            Stage::Geometry => "geometry",
            Stage::Fragment => "fragment",
        };
        let _ = writeln!(text, "{key} = {}", toml_string(name));
    }
    text.push_str(&head.sources);
    let _ = writeln!(text, "primitive = \"{}\"", primitive(reads, form));
    if reads.point_size && primitive(reads, form) == "points" {
        text.push_str("program_point_size = true\n");
    }
    if reads.is_shown_by_alpha() {
        text.push_str("blend = \"alpha\"   # only the alpha of its color differs\n");
    }
    match form {
        Form::Mesh(shape, _) => {
            text.push_str("depth_test = true\ndepth_func = \"lequal\"\n");
            let _ = writeln!(text, "mesh = {{ {} }}", mesh(reads, shape));
        }
        Form::Count(_, count) => {
            let _ = writeln!(text, "vertex_count = {count}   # without attributes: positions come from gl_VertexID");
        }
        Form::Square(..) | Form::Pixels => {}
    }
}

fn primitive(reads: &Reads<'_>, form: &Form) -> &'static str {
    let is_mesh = matches!(form, Form::Mesh(..));
    match (reads.geometry, form) {
        (_, Form::Count(primitive, _)) => primitive,
        (Some(PrimitiveIn::Points), _) => "points",
        (Some(PrimitiveIn::Lines), _) => {
            if is_mesh {
                "lines"
            } else {
                "line_strip"
            }
        }
        (Some(PrimitiveIn::LinesAdjacency), _) => "lines_adjacency",
        (Some(PrimitiveIn::TrianglesAdjacency), _) => {
            if is_mesh {
                "triangles_adjacency"
            } else {
                "triangle_strip_adjacency"
            }
        }
        (None, _) if reads.point_coord => "points",
        (_, Form::Mesh(..)) => "triangles",
        _ => "triangle_strip",
    }
}

/// The keys of a mesh: its shape, and the attributes that take its data.
fn mesh(reads: &Reads<'_>, shape: &Shape) -> String {
    let mut text = match shape {
        Shape::Named(name, 1.0) => format!("shape = {}", toml_string(name)),
        Shape::Named(name, radius) => format!("shape = {}, radius = {radius:?}", toml_string(name)),
        Shape::File(name) => format!("file = {}", toml_string(name)),
    };
    for input in &reads.inputs {
        if let Some(role) = input.role.filter(|role| MESH_ROLES.contains(role)) {
            let _ = write!(text, ", {} = {}", role.name(), toml_string(input.name));
        }
    }
    text
}

/// The data of attributes that no mesh has.
fn attributes(text: &mut String, reads: &Reads<'_>, choice: &Choice) {
    let (lines, header): (Vec<String>, &str) = match &choice.form {
        Form::Count(..) => return,
        Form::Mesh(..) => {
            let of_mesh = |input: &&Input<'_>| input.role.is_none_or(|role| !MESH_ROLES.contains(&role));
            let line = |input: &Input<'_>| {
                let row = numbers(reads, input, &corner(reads, input, 3, (0.0, 0.0), choice));
                line_of(reads, input, "divisor = 1, ", &row)
            };
            (reads.inputs.iter().filter(of_mesh).map(line).collect(), "[draw.attributes]   # the same for all vertices")
        }
        Form::Square(low, high, _) => (rows(reads, (*low, *high), choice), ROWS),
        Form::Pixels => (rows(reads, (0.0, f64::from(choice.side)), choice), ROWS),
    };
    table(text, header, &lines);
}

const ROWS: &str = "[draw.attributes]   # one row of `size` numbers for each vertex";

/// The data of all attributes at the corners of a square.
fn rows(reads: &Reads<'_>, range: Range, choice: &Choice) -> Vec<String> {
    let mut lines = fixed_rows(reads, range);
    for input in &reads.inputs {
        let row = |number: usize| numbers(reads, input, &corner(reads, input, number, range, choice));
        let all: Vec<String> = (0..CORNERS.len()).map(row).collect();
        lines.push(line_of(reads, input, "", &all.join(",  ")));
    }
    lines
}

/// The data of the attributes of the fixed-function pipeline.
fn fixed_rows(reads: &Reads<'_>, (low, high): Range) -> Vec<String> {
    let attributes = &reads.program.interface.attributes;
    let is_read = |name: &str| {
        attributes.iter().any(|known| known.active && known.name == name) || reads.is_passed_by_pipeline(name)
    };
    let place = |value: f64| low + (high - low) * (value + 1.0) / 2.0;
    let rows = |row: &dyn Fn(f64, f64) -> String| CORNERS.map(|[x, y]| row(x, y)).join(",  ");
    let mut lines = Vec::new();
    if reads.fixed.vertex {
        let values = rows(&|x, y| format!("{:?}, {:?}", place(x), place(y)));
        lines.push(format!("gl_Vertex = {{ size = 2, values = [{values}] }}"));
    }
    for unit in (0..8).filter(|unit| is_read(&format!("gl_MultiTexCoord{unit}"))) {
        let values = rows(&|x, y| format!("{:?}, {:?}", (x + 1.0) / 2.0, (y + 1.0) / 2.0));
        lines.push(format!("gl_MultiTexCoord{unit} = {{ size = 2, values = [{values}] }}"));
    }
    if is_read("gl_Color") {
        let values = rows(&|x, y| format!("{:?}, {:?}, 0.4", 0.6 + 0.4 * x, 0.6 + 0.4 * y));
        lines.push(format!("gl_Color = {{ size = 3, values = [{values}] }}"));
    }
    lines
}

fn numbers(reads: &Reads<'_>, input: &Input<'_>, row: &[f64]) -> String {
    let scalar = scalar_of(&reads.program.types, input.ty).unwrap_or(Scalar::Float);
    row.iter().map(|number| text_of(*number, scalar)).collect::<Vec<_>>().join(", ")
}

fn line_of(reads: &Reads<'_>, input: &Input<'_>, divisor: &str, values: &str) -> String {
    let ty = reads.program.types.name(input.ty);
    format!("{} = {{ size = {}, {divisor}values = [{values}] }}   # {ty}", key(input.name), input.size)
}

/// The lines of `[draw.matrices]` and of `[draw.uniforms]`.
fn uniforms(reads: &Reads<'_>, choice: &Choice) -> (Vec<String>, Vec<String>) {
    let (mut matrices, mut numbers) = (Vec::new(), Vec::new());
    for leaf in &reads.uniforms {
        let ty = with_array(reads, leaf);
        match role(reads, leaf, &choice.form) {
            Some(role) if choice.form == Form::Pixels => {
                numbers.push(format!("{} = [{}]   # {ty}", key(&leaf.name), pixels(role, choice.side)));
            }
            Some(role) => {
                let role = toml_string(role.name());
                match leaf.array_size {
                    None => matrices.push(format!("{} = {role}", key(&leaf.name))),
                    Some(size) => {
                        let line =
                            |element: u32| format!("{} = {role}", toml_string(&format!("{}[{element}]", leaf.name)));
                        matrices.extend((0..size).map(line));
                    }
                }
            }
            None => {
                let value = uniform_text(reads, leaf, choice);
                numbers.push(format!("{} = {value}   # {ty}", key(&leaf.name)));
            }
        }
    }
    numbers.extend(fog(reads));
    for leaf in &reads.initialized {
        let value = uniform_text(reads, leaf, choice);
        let ty = with_array(reads, leaf);
        numbers.push(format!("# {} = {value}   # {ty}, has an initializer", key(&leaf.name)));
    }
    (matrices, numbers)
}

fn with_array(reads: &Reads<'_>, leaf: &UniformLeaf) -> String {
    let array = leaf.array_size.map_or_else(String::new, |size| format!("[{size}]"));
    format!("{}{array}", reads.program.types.name(leaf.ty))
}

/// The role of a uniform that the camera fills.
fn role(reads: &Reads<'_>, leaf: &UniformLeaf, form: &Form) -> Option<MatrixRole> {
    if leaf.array_size.is_some_and(|size| size > MAX_ELEMENTS) {
        return None;
    }
    let ty = reads.program.types.get(leaf.ty);
    let is_transform = matches!(ty, Type::Matrix(4, 4)) && is_plain_transform(own_name(leaf));
    let role = named_role(leaf, ty).or_else(|| is_transform.then(|| of_transform(reads)))?;
    // Without a camera, it would be in the middle of what is drawn.
    let has_camera =
        matches!(form, Form::Mesh(_, View::Camera | View::Front) | Form::Square(_, _, View::Camera | View::Front));
    (role != MatrixRole::Eye || (has_camera && reads.has_matrices())).then_some(role)
}

/// The role of a matrix whose name says no more than that it transforms: all of the transformation, or what others leave.
fn of_transform(reads: &Reads<'_>) -> MatrixRole {
    let types = &reads.program.types;
    let has = |wanted: &[MatrixRole]| {
        let roles = reads.uniforms.iter().filter_map(|leaf| named_role(leaf, types.get(leaf.ty)));
        roles.into_iter().any(|role| wanted.contains(&role))
    };
    if has(&[MatrixRole::Projection, MatrixRole::ViewProjection, MatrixRole::ModelViewProjection]) {
        return if has(&[MatrixRole::View, MatrixRole::ViewProjection]) {
            MatrixRole::Model
        } else {
            MatrixRole::ModelView
        };
    }
    MatrixRole::ModelViewProjection
}

/// A matrix for positions in pixels.
fn pixels(role: MatrixRole, side: u32) -> String {
    let projects =
        [MatrixRole::Projection, MatrixRole::ViewProjection, MatrixRole::ModelViewProjection].contains(&role);
    let scale = 2.0 / f64::from(side);
    let matrix = match role {
        _ if projects => vec![scale, 0.0, 0.0, 0.0, 0.0, scale, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, -1.0, -1.0, 0.0, 1.0],
        MatrixRole::Normal | MatrixRole::ModelNormal => identity(3, 3),
        MatrixRole::Eye => vec![0.0, 0.0, 3.0],
        _ => identity(4, 4),
    };
    matrix.into_iter().map(|number| text_of(number, Scalar::Float)).collect::<Vec<_>>().join(", ")
}

/// Fog, whose initial values would leave nothing but its color.
fn fog(reads: &Reads<'_>) -> Vec<String> {
    if !reads.fixed.fog {
        return Vec::new();
    }
    let lines = ["color\" = [0.5, 0.6, 0.7, 1.0]", "density\" = 0.1", "start\" = 1.0", "end\" = 8.0"];
    lines.map(|line| format!("\"gl_Fog.{line}")).to_vec()
}

fn samplers(reads: &Reads<'_>, taste: Taste) -> Vec<String> {
    let line = |(number, slot): (usize, &&SamplerSlot)| {
        let Type::Sampler(kind) = reads.program.types.get(slot.ty) else { return None };
        let name = slot.name.rsplit('.').next().unwrap_or(&slot.name);
        let ty = reads.program.types.name(slot.ty);
        Some(format!(
            "{} = {}   # {ty}",
            key(&slot.name),
            textures::table(name, kind, Needs { taste, number, is_fetched: reads.fetches })
        ))
    };
    let mut lines: Vec<String> = reads.samplers.iter().enumerate().filter_map(line).collect();
    if reads.passes("gl_TexCoord") {
        lines.push(format!("texture0 = {}", textures::CHECKER));
    }
    lines
}

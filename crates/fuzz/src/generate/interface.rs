//! [`Interface`]: what crosses the stages of a generated program, and the scene that gives it values.
//!
//! *In:* a language. *Out:* declarations for each stage, with the variables that they declare, and the lines of a scene. *Holds:* both stages
//! declare the same; every uniform and every texture has a value in the scene.

use super::language::Language;
use super::samplers::Sampler;
use super::tree::Variable;
use super::types::{BOOL, FLOAT, INT, Members, Ty};
use crate::chance::Chance;
use glisten_front::hir::{Scalar, Stage};
use glisten_front::language::Feature;

/// The side of the picture, in pixels.
pub const SIDE: usize = 4;

/// A varying, or a block of them.
#[derive(Clone, Debug)]
pub(super) struct Varying {
    /// Its name.
    pub(super) name: String,
    /// The members of a block, or the varying itself under no name.
    pub(super) parts: Vec<(String, Ty)>,
    qualifiers: &'static str,
    is_block: bool,
}

/// A uniform, or a block of them.
#[derive(Clone, Debug)]
struct Uniform {
    declaration: String,
    variables: Vec<(String, Ty)>,
    /// Lines of `[draw.uniforms]`.
    lines: Vec<String>,
    construct: &'static str,
}

/// The interface of the stages.
#[derive(Clone, Debug)]
pub(super) struct Interface {
    pub(super) varyings: Vec<Varying>,
    pub(super) samplers: Vec<&'static Sampler>,
    uniforms: Vec<Uniform>,
    outputs: usize,
    has_integers: bool,
}

impl Interface {
    pub(super) fn new(chance: &mut Chance, language: &Language, structs: &[Members]) -> Self {
        let outputs = if language.version.is_es() && !language.since(110, 300) { 1 } else { 1 + chance.below(4) };
        let all: Vec<&'static Sampler> = Sampler::all(language).collect();
        let samplers = all.into_iter().filter(|_| chance.once_in(4)).take(4).collect();
        let mut uniforms = vec![
            plain(chance, "uf", &FLOAT),
            plain(chance, "ui", &INT),
            Uniform {
                declaration: "uniform bool never;".to_owned(),
                variables: Vec::new(),
                lines: vec!["never = false".to_owned()],
                construct: "uniform",
            },
        ];
        for number in 0..chance.below(4) {
            let basic = uniform_type(chance, language);
            let ty = if chance.once_in(3) { Ty::Array(Box::new(basic), 2 + chance.below(3) as u32) } else { basic };
            uniforms.push(plain(chance, &format!("u{number}"), &ty));
        }
        if !structs.is_empty() && chance.once_in(2) {
            let number = chance.below(structs.len());
            uniforms.extend(of_struct(chance, number, structs));
        }
        if language.has(Feature::UniformBlocks) && chance.once_in(2) {
            uniforms.push(block(chance, language));
        }
        let mut varyings = Vec::new();
        for number in 0..1 + chance.below(4) {
            varyings.push(varying(chance, language, structs, number));
        }
        Self { varyings, samplers, uniforms, outputs, has_integers: language.has(Feature::IntegerInterfaces) }
    }

    /// The names of the outputs.
    pub(super) fn outputs(&self, language: &Language) -> Vec<String> {
        let is_own = language.has(Feature::InOut);
        let name = |index: usize| match (is_own, self.outputs) {
            (true, _) => format!("c{index}"),
            (false, 1) => "gl_FragColor".to_owned(),
            (false, _) => format!("gl_FragData[{index}]"),
        };
        (0..self.outputs).map(name).collect()
    }

    /// The constructs that the interface has.
    pub(super) fn constructs(&self) -> Vec<&'static str> {
        let mut all: Vec<&'static str> = self.uniforms.iter().map(|one| one.construct).collect();
        for one in &self.varyings {
            all.push(if one.is_block { "interface block" } else { "varying" });
            all.extend(one.qualifiers.split_whitespace());
            if one.parts.iter().any(|(_, ty)| matches!(ty, Ty::Struct(_))) {
                all.push("struct as a varying");
            }
        }
        all.extend(self.samplers.iter().map(|one| one.word));
        all
    }

    /// The declarations of a stage, each with what it declares.
    pub(super) fn declarations(&self, stage: Stage, language: &Language) -> Vec<(String, Vec<Variable>)> {
        let is_vertex = stage == Stage::Vertex;
        let variable = |name: &str, ty: &Ty| Variable {
            name: name.to_owned(),
            ty: ty.clone(),
            writable: false,
            constant: false,
            local: false,
            below: None,
        };
        let mut all = Vec::new();
        for one in &self.uniforms {
            let variables = one.variables.iter().map(|(name, ty)| variable(name, ty)).collect();
            all.push((one.declaration.clone(), variables));
        }
        for one in &self.samplers {
            all.push((format!("uniform {} {};", one.word, one.name), Vec::new()));
        }
        let is_new = language.has(Feature::InOut);
        if is_vertex {
            let word = if is_new { "in" } else { "attribute" };
            let whole = Ty::Vector(if self.has_integers { Scalar::Int } else { Scalar::Float }, 4);
            for (name, ty) in [
                ("place", Ty::Vector(Scalar::Float, 2)),
                ("pw", FLOAT),
                ("av", Ty::Vector(Scalar::Float, 4)),
                ("bv", whole),
            ] {
                all.push((format!("{word} {};", ty.declared(name)), vec![variable(name, &ty)]));
            }
        }
        let direction = match (is_new, is_vertex) {
            (false, _) => "varying",
            (true, true) => "out",
            (true, false) => "in",
        };
        for one in &self.varyings {
            let variables = if is_vertex { Vec::new() } else { one.variables(&variable) };
            all.push((one.declaration(direction), variables));
        }
        let mut built_in = Vec::new();
        if is_vertex {
            built_in.extend(language.since(130, 300).then(|| variable("gl_VertexID", &INT)));
            built_in.extend(language.since(140, 300).then(|| variable("gl_InstanceID", &INT)));
        } else {
            built_in.push(variable("gl_FragCoord", &Ty::Vector(Scalar::Float, 4)));
            built_in.push(variable("gl_FrontFacing", &BOOL));
            if is_new {
                for index in 0..self.outputs {
                    let layout =
                        if language.since(330, 300) { format!("layout(location = {index}) ") } else { String::new() };
                    all.push((format!("{layout}out vec4 c{index};"), Vec::new()));
                }
            }
        }
        all.first_mut().into_iter().for_each(|(_, variables)| variables.append(&mut built_in));
        all
    }

    /// The lines of the scene.
    pub(super) fn scene(&self) -> Vec<String> {
        let bv = if self.has_integers { "" } else { ".0" };
        let whole: Vec<String> =
            [3, -1, 5, 8, 0, 2, -7, 4, 1, 6, 100, -3].iter().map(|number| format!("{number}{bv}")).collect();
        let mut lines = vec![
            format!(
                "framebuffer = {{ width = {SIDE}, height = {SIDE}, attachments = {}, clear = [0, 0, 0, 0] }}",
                self.outputs
            ),
            "[[draw]]".to_owned(),
            "vertex = \"a.vert\"".to_owned(),
            "fragment = \"a.frag\"".to_owned(),
            "primitive = \"triangles\"".to_owned(),
            "[draw.attributes]".to_owned(),
            "place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }".to_owned(),
            "pw = { size = 1, values = [1, 2, 1.5] }".to_owned(),
            "av = { size = 4, values = [0.5, -1, 2, 0.25, 3, 1, -0.5, 0.75, -2, 0.125, 1, 1.5] }".to_owned(),
            format!("bv = {{ size = 4, values = [{}] }}", whole.join(", ")),
            "[draw.uniforms]".to_owned(),
        ];
        lines.extend(self.uniforms.iter().flat_map(|one| one.lines.clone()));
        if !self.samplers.is_empty() {
            lines.push("[draw.textures]".to_owned());
            lines.extend(self.samplers.iter().map(|one| one.line()));
        }
        lines
    }
}

impl Varying {
    fn declaration(&self, direction: &str) -> String {
        if self.is_block {
            let members: Vec<String> = self
                .parts
                .iter()
                .map(|(name, ty)| {
                    let flat = if ty.is_vector_of(Scalar::Int) { "flat " } else { "" };
                    format!("{flat}{};", ty.declared(name))
                })
                .collect();
            return format!("{direction} Io{} {{ {} }} {};", self.name, members.join(" "), self.name);
        }
        let declared = self.parts.first().map_or(String::new(), |(_, ty)| ty.declared(&self.name));
        format!("{}{direction} {declared};", self.qualifiers)
    }

    fn variables(&self, variable: &dyn Fn(&str, &Ty) -> Variable) -> Vec<Variable> {
        let name = |member: &str| if self.is_block { format!("{}.{member}", self.name) } else { self.name.clone() };
        self.parts.iter().map(|(member, ty)| variable(&name(member), ty)).collect()
    }
}

fn varying(chance: &mut Chance, language: &Language, structs: &[Members], number: usize) -> Varying {
    let float = |chance: &mut Chance| Ty::Vector(Scalar::Float, 1 + chance.below(4) as u8);
    let name = format!("y{number}");
    let is_new = language.has(Feature::InOut);
    if language.has(Feature::InterfaceBlocks) && chance.once_in(3) {
        let whole = Ty::Vector(Scalar::Int, 1 + chance.below(4) as u8);
        let parts = vec![("a".to_owned(), float(chance)), ("b".to_owned(), whole)];
        return Varying { name, parts, qualifiers: "", is_block: true };
    }
    let is_float = |ty: &Ty| matches!(ty, Ty::Vector(Scalar::Float, _));
    let plain: Vec<usize> = (0..structs.len())
        .filter(|index| structs.get(*index).is_some_and(|all| all.iter().all(|(_, ty)| is_float(ty))))
        .collect();
    let ty = match chance.below(6) {
        0 if language.has(Feature::IntegerInterfaces) => Ty::Vector(Scalar::Int, 1 + chance.below(4) as u8),
        1 if language.has(Feature::ArrayObjects) => Ty::Array(Box::new(float(chance)), 2),
        2 => Ty::Matrix(2, 2),
        3 if language.has(Feature::StructInterfaces) && !plain.is_empty() => {
            Ty::Struct(chance.one(&plain).copied().unwrap_or(0))
        }
        _ => float(chance),
    };
    let qualifiers = match (is_new, language.version.is_es()) {
        _ if ty.is_vector_of(Scalar::Int) => "flat ",
        (false, _) => "",
        (true, false) => chance.word(&["", "smooth ", "flat ", "noperspective ", "centroid ", "smooth centroid "]),
        (true, true) => chance.word(&["", "smooth ", "flat "]),
    };
    Varying { name, parts: vec![(String::new(), ty)], qualifiers, is_block: false }
}

fn uniform_type(chance: &mut Chance, language: &Language) -> Ty {
    let fitting: Vec<Ty> = language.basics.iter().filter(|ty| ty.scalar() != Some(Scalar::Bool)).cloned().collect();
    chance.one(&fitting).cloned().unwrap_or(FLOAT)
}

/// Numbers for a type, as the scene writes them.
fn numbers(chance: &mut Chance, ty: &Ty) -> Vec<String> {
    const FLOATS: &[&str] = &["0.5", "-2.0", "3.0", "0.25", "1.0", "-0.75", "0.0", "0.3", "1.5"];
    match ty {
        Ty::Vector(scalar, size) => {
            let words: &[&'static str] = match scalar {
                Scalar::Float => FLOATS,
                Scalar::Int => &["3", "-5", "0", "1", "7", "100"],
                Scalar::Uint => &["3", "5", "0", "255", "65537"],
                Scalar::Bool => &["true", "false"],
            };
            (0..*size).map(|_| chance.word(words).to_owned()).collect()
        }
        Ty::Matrix(columns, rows) => (0..columns * rows).map(|_| chance.word(FLOATS).to_owned()).collect(),
        Ty::Array(element, size) => (0..*size).flat_map(|_| numbers(chance, element)).collect(),
        Ty::Struct(_) => Vec::new(),
    }
}

/// The line of a uniform in the scene.
fn line(chance: &mut Chance, name: &str, ty: &Ty) -> String {
    let numbers = numbers(chance, ty);
    match ty {
        Ty::Vector(_, 1) => format!("\"{name}\" = {}", numbers.concat()),
        _ => format!("\"{name}\" = [{}]", numbers.join(", ")),
    }
}

fn plain(chance: &mut Chance, name: &str, ty: &Ty) -> Uniform {
    Uniform {
        declaration: format!("uniform {};", ty.declared(name)),
        variables: vec![(name.to_owned(), ty.clone())],
        lines: vec![line(chance, name, ty)],
        construct: if matches!(ty, Ty::Array(..)) { "uniform array" } else { "uniform" },
    }
}

/// A uniform of a struct, if the scene can name its members.
fn of_struct(chance: &mut Chance, number: usize, structs: &[Members]) -> Option<Uniform> {
    let mut lines = Vec::new();
    for (name, ty) in structs.get(number)? {
        if matches!(ty, Ty::Struct(_)) || ty.scalar() == Some(Scalar::Bool) || ty.has_array(structs) {
            return None;
        }
        lines.push(line(chance, &format!("us.{name}"), ty));
    }
    Some(Uniform {
        declaration: format!("uniform S{number} us;"),
        variables: vec![("us".to_owned(), Ty::Struct(number))],
        lines,
        construct: "uniform of a struct",
    })
}

fn block(chance: &mut Chance, language: &Language) -> Uniform {
    let layout = chance.word(&["", "layout(std140) ", "layout(std140, row_major) ", "layout(shared) "]);
    let has_instance = language.has(Feature::BlockInstances) && chance.once_in(2);
    let (mut members, mut variables, mut lines) = (String::new(), Vec::new(), Vec::new());
    for index in 0..2 + chance.below(3) {
        let basic = uniform_type(chance, language);
        let ty = if chance.once_in(3) { Ty::Array(Box::new(basic), 2) } else { basic };
        let name = format!("k{index}");
        let order = if matches!(ty, Ty::Matrix(..)) {
            chance.word(&["", "layout(row_major) ", "layout(column_major) "])
        } else {
            ""
        };
        members.push_str(&format!(" {order}{};", ty.declared(&name)));
        // OpenGL names the members of a block by its own name if it has an instance.
        let path = if has_instance { format!("Block.{name}") } else { name.clone() };
        lines.push(line(chance, &path, &ty));
        variables.push((if has_instance { format!("block.{name}") } else { name }, ty));
    }
    let instance = if has_instance { " block" } else { "" };
    Uniform {
        declaration: format!("{layout}uniform Block {{{members} }}{instance};"),
        variables,
        lines,
        construct: if has_instance { "uniform block with an instance" } else { "uniform block" },
    }
}

//! [`Interface`]: what crosses the stages of a generated program, and the scene that gives it values.
//!
//! *In:* a language. *Out:* declarations for each stage, with the variables that they declare, and the lines of a scene. *Holds:* both stages
//! declare the same; every uniform and every texture has a value in the scene.

use super::language::Language;
use super::samplers::Sampler;
use super::tree::Variable;
use super::types::{BOOL, FLOAT, INT, Members, Ty};
use super::uniforms::Uniform;
use crate::chance::Chance;
use glisten_front::hir::{Scalar, Stage};
use glisten_front::language::Feature;

/// The side of the picture, in pixels.
pub const SIDE: usize = 4;

/// The varying that passes the sum of the vertex stage on.
pub(super) const PASSED: &str = "ya";

/// The beginning of the names of varyings behind a geometry stage.
const LATER: &str = "z";

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

/// The interface of the stages.
#[derive(Clone, Debug)]
pub(super) struct Interface {
    pub(super) varyings: Vec<Varying>,
    pub(super) samplers: Vec<&'static Sampler>,
    uniforms: Vec<Uniform>,
    outputs: usize,
    has_integers: bool,
    /// Whether there is a geometry stage.
    pub(super) has_geometry: bool,
    /// How many clip distances are enabled, if the vertex stage writes two of them.
    clips: Option<usize>,
}

impl Interface {
    pub(super) fn new(chance: &mut Chance, language: &Language, structs: &[Members]) -> Self {
        let outputs = if language.version.is_es() && !language.since(110, 300) { 1 } else { 1 + chance.below(4) };
        let all: Vec<&'static Sampler> = Sampler::all(language).collect();
        let samplers = all.into_iter().filter(|_| chance.once_in(4)).take(4).collect();
        let uniforms = Uniform::all(chance, language, structs);
        // No target has a geometry stage, so that most programs have none, either.
        let has_geometry = language.since(150, u16::MAX) && chance.once_in(12);
        let mut varyings = Vec::new();
        for number in 0..1 + chance.below(4) {
            varyings.push(varying(chance, language, structs, (number, has_geometry)));
        }
        let qualifiers = if language.has(Feature::InOut) { chance.word(&["", "flat "]) } else { "" };
        let parts = vec![(String::new(), Ty::Vector(Scalar::Float, 4))];
        varyings.push(Varying { name: PASSED.to_owned(), parts, qualifiers, is_block: false });
        let clips = (language.since(130, u16::MAX) && !has_geometry && chance.once_in(5)).then(|| chance.below(3));
        let has_integers = language.has(Feature::IntegerInterfaces);
        Self { varyings, samplers, uniforms, outputs, has_integers, has_geometry, clips }
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

    /// The varyings that a stage writes.
    pub(super) fn written(&self, stage: Stage) -> Vec<Varying> {
        let is_last = stage == Stage::Geometry;
        self.varyings.iter().map(|one| if is_last { one.passed_on() } else { one.clone() }).collect()
    }

    /// The varyings that a stage reads; those of a geometry stage are arrays of them.
    fn read(&self, stage: Stage) -> Vec<Varying> {
        match stage {
            Stage::Vertex => Vec::new(),
            Stage::Geometry => self.varyings.clone(),
            Stage::Fragment => self.written(if self.has_geometry { Stage::Geometry } else { Stage::Vertex }),
        }
    }

    /// The varying that carries the sum into a fragment stage.
    pub(super) fn passed(&self) -> String {
        if self.has_geometry { format!("{LATER}{PASSED}") } else { PASSED.to_owned() }
    }

    /// Whether the vertex stage writes clip distances.
    pub(super) fn has_clips(&self) -> bool {
        self.clips.is_some()
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
        all.extend(self.clips.map(|_| "gl_ClipDistance"));
        all.extend(self.has_geometry.then_some("geometry stage"));
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
            all.push((one.declaration.clone(), one.visible(&variable)));
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
        if is_vertex && self.clips.is_some() {
            all.push(("out float gl_ClipDistance[2];".to_owned(), Vec::new()));
        }
        let is_geometry = stage == Stage::Geometry;
        if is_geometry {
            all.push(("layout(triangles) in;".to_owned(), Vec::new()));
            all.push(("layout(triangle_strip, max_vertices = 3) out;".to_owned(), Vec::new()));
        }
        for one in self.read(stage) {
            let word = if is_new { "in" } else { "varying" };
            let corners: Vec<String> =
                if is_geometry { (0..3).map(|corner| format!("[{corner}]")).collect() } else { vec![String::new()] };
            let variables = corners.iter().flat_map(|corner| one.variables(corner, &variable)).collect();
            all.push((one.declaration(word, if is_geometry { "[]" } else { "" }), variables));
        }
        if stage != Stage::Fragment {
            let word = if is_new { "out" } else { "varying" };
            all.extend(self.written(stage).iter().map(|one| (one.declaration(word, ""), Vec::new())));
        }
        let mut built_in = Vec::new();
        if is_vertex {
            built_in.extend(language.since(130, 300).then(|| variable("gl_VertexID", &INT)));
            built_in.extend(language.since(140, 300).then(|| variable("gl_InstanceID", &INT)));
        } else if is_geometry {
            built_in.push(variable("gl_PrimitiveIDIn", &INT));
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
            if self.has_geometry { "geometry = \"a.geom\"".to_owned() } else { String::new() },
            format!("clip_distances = {}", self.clips.unwrap_or(0)),
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
    /// The varying that a geometry stage writes for this one.
    fn passed_on(&self) -> Self {
        Self { name: format!("{LATER}{}", self.name), ..self.clone() }
    }

    /// The names of its parts behind an index.
    pub(super) fn places(&self, index: &str) -> Vec<String> {
        let name = &self.name;
        let place = |member: &String| {
            if self.is_block { format!("{name}{index}.{member}") } else { format!("{name}{index}") }
        };
        self.parts.iter().map(|(member, _)| place(member)).collect()
    }

    fn declaration(&self, direction: &str, brackets: &str) -> String {
        if self.is_block {
            let members: Vec<String> = self
                .parts
                .iter()
                .map(|(name, ty)| {
                    let flat = if ty.is_vector_of(Scalar::Int) { "flat " } else { "" };
                    format!("{flat}{};", ty.declared(name))
                })
                .collect();
            let (name, members) = (&self.name, members.join(" "));
            return format!("{direction} Io{name} {{ {members} }} {name}{brackets};");
        }
        let declared = self.parts.first().map_or(String::new(), |(_, ty)| ty.declared(&self.name));
        format!("{}{direction} {declared}{brackets};", self.qualifiers)
    }

    fn variables(&self, index: &str, variable: &dyn Fn(&str, &Ty) -> Variable) -> Vec<Variable> {
        self.places(index).iter().zip(&self.parts).map(|(place, (_, ty))| variable(place, ty)).collect()
    }
}

fn varying(
    chance: &mut Chance,
    language: &Language,
    structs: &[Members],
    (number, is_one_of_many): (usize, bool),
) -> Varying {
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
        1 if language.has(Feature::ArrayObjects) && !is_one_of_many => Ty::Array(Box::new(float(chance)), 2),
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

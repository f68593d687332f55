//! Uniforms of generated programs: plain ones, structs, arrays of structs, blocks, and their values in the scene.
//!
//! *In:* a language and its structs. *Out:* declarations, with variables and lines of the scene. *Holds:* every member has a value in the scene,
//! under the name that OpenGL gives it.

use super::language::Language;
use super::tree::Variable;
use super::types::{FLOAT, INT, Members, Ty};
use crate::chance::Chance;
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

/// A uniform, or a block of them.
#[derive(Clone, Debug)]
pub(super) struct Uniform {
    pub(super) declaration: String,
    pub(super) variables: Vec<(String, Ty)>,
    /// Lines of `[draw.uniforms]`.
    pub(super) lines: Vec<String>,
    pub(super) construct: &'static str,
}

impl Uniform {
    /// The uniforms of a program.
    pub(super) fn all(chance: &mut Chance, language: &Language, structs: &[Members]) -> Vec<Self> {
        let mut uniforms = vec![
            plain(chance, "uf", &FLOAT),
            plain(chance, "ui", &INT),
            Self {
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
            uniforms.push(of_struct(chance, number, structs));
        }
        if language.has(Feature::UniformBlocks) && chance.once_in(2) {
            uniforms.push(block(chance, language, structs));
        }
        uniforms
    }

    /// The variables as the stages see them.
    pub(super) fn visible(&self, variable: &dyn Fn(&str, &Ty) -> Variable) -> Vec<Variable> {
        self.variables.iter().map(|(name, ty)| variable(name, ty)).collect()
    }
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

/// The lines of a value with members: one for each of them.
fn lines(chance: &mut Chance, path: &str, ty: &Ty, structs: &[Members]) -> Vec<String> {
    match ty {
        Ty::Struct(number) => {
            let members = structs.get(*number).cloned().unwrap_or_default();
            members.iter().flat_map(|(name, ty)| lines(chance, &format!("{path}.{name}"), ty, structs)).collect()
        }
        Ty::Array(element, size) if matches!(**element, Ty::Struct(_)) => {
            (0..*size).flat_map(|index| lines(chance, &format!("{path}[{index}]"), element, structs)).collect()
        }
        _ => vec![line(chance, path, ty)],
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

/// A uniform of a struct, or an array of them.
fn of_struct(chance: &mut Chance, number: usize, structs: &[Members]) -> Uniform {
    let is_array = chance.once_in(3);
    let ty = if is_array { Ty::Array(Box::new(Ty::Struct(number)), 2) } else { Ty::Struct(number) };
    Uniform {
        declaration: format!("uniform {};", ty.declared("us")),
        lines: lines(chance, "us", &ty, structs),
        variables: vec![("us".to_owned(), ty)],
        construct: if is_array { "uniform array of structs" } else { "uniform of a struct" },
    }
}

fn block(chance: &mut Chance, language: &Language, structs: &[Members]) -> Uniform {
    let layout = chance.word(&["", "layout(std140) ", "layout(std140, row_major) ", "layout(shared) "]);
    let has_instance = language.has(Feature::BlockInstances) && chance.once_in(2);
    let size = (has_instance && language.since(150, 300) && chance.once_in(3)).then_some(2_usize);
    let (mut members, mut variables, mut all) = (String::new(), Vec::new(), Vec::new());
    for index in 0..2 + chance.below(3) {
        let basic = uniform_type(chance, language);
        let basic =
            if structs.is_empty() || !chance.once_in(4) { basic } else { Ty::Struct(chance.below(structs.len())) };
        let ty = if chance.once_in(3) { Ty::Array(Box::new(basic), 2) } else { basic };
        let name = format!("k{index}");
        let order = if matches!(ty, Ty::Matrix(..)) {
            chance.word(&["", "layout(row_major) ", "layout(column_major) "])
        } else {
            ""
        };
        members.push_str(&format!(" {order}{};", ty.declared(&name)));
        // OpenGL names the members of a block by its own name if it has an instance.
        let elements = || (0..size.unwrap_or(1)).map(|index| size.map_or(String::new(), |_| format!("[{index}]")));
        for element in elements() {
            let path = if has_instance { format!("Block{element}.{name}") } else { name.clone() };
            all.extend(lines(chance, &path, &ty, structs));
            variables.push((if has_instance { format!("block{element}.{name}") } else { name.clone() }, ty.clone()));
        }
    }
    let instance = match (has_instance, size) {
        (true, Some(size)) => format!(" block[{size}]"),
        (true, None) => " block".to_owned(),
        _ => String::new(),
    };
    Uniform {
        declaration: format!("{layout}uniform Block {{{members} }}{instance};"),
        variables,
        lines: all,
        construct: match (has_instance, size) {
            (_, Some(_)) => "array of uniform blocks",
            (true, None) => "uniform block with an instance",
            _ => "uniform block",
        },
    }
}

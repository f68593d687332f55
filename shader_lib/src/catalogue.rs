//! The catalogue: each module with its header, its functions, their documentation and their cost.
//!
//! *In:* the embedded modules. *Out:* an [`Entry`] for each, from the header and the compiled text, so that nothing
//! is written twice by hand.

use super::cost::{Cost, cost};
use super::header::{Header, notes, paragraphs};
use super::{Embedded, Module, SHOWN, modules};
use glisten_front::hir::{Function, Stage, Types};
use glisten_front::{Compiler, Options, Source};
use serde::Serialize;

/// A function of a module.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FunctionEntry {
    /// The name, which overloads share.
    pub name: String,
    /// The name and the types of the parameters: `lambertFactor(vec3,vec3)`.
    pub signature: String,
    /// The declaration: `float lambertFactor(vec3 N, vec3 L)`.
    pub declaration: String,
    /// The comment: what the function computes, then one line per parameter.
    pub documentation: String,
    /// The largest error that is allowed for stiff and extreme inputs, as its comment states it: what follows `bound:`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<String>,
    /// The cost of a call.
    pub cost: Cost,
}

/// A module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The module.
    pub module: &'static Module,
    /// The header.
    pub header: Header<'static>,
    /// Notes about the whole module; may be empty.
    pub notes: String,
    /// The functions that it defines, in source order.
    pub functions: Vec<FunctionEntry>,
}

/// A shader that includes a module and does not use it.
fn shader_with(module: &Module) -> Source {
    let text = format!(
        "#version 150\n#extension GL_ARB_shading_language_include : require\n#include <glisten/{}.glsl>\n\
         out vec4 color;\nvoid main() {{ color = vec4(1.0); }}\n",
        module.name
    );
    Source { name: format!("{}.frag", module.name), text: text.into(), stage: Stage::Fragment }
}

/// The entry of a module.
pub fn entry(module: &'static Module) -> Entry {
    let compilation = Compiler::new(Options::default()).with_includes(Embedded).compile(&[shader_with(module)]);
    let own = format!("{SHOWN}{}.glsl", module.name);
    let mut functions = Vec::new();
    // Every module compiles, as a test checks.
    let stages =
        compilation.program.iter().flat_map(|program| program.stages.iter().map(move |shader| (program, shader)));
    for (program, shader) in stages {
        for (id, function) in shader.functions() {
            let file = compilation.sources.file_of(function.span).map(|file| compilation.sources.file(file));
            if file.is_some_and(|file| file.name() == own) {
                let line = compilation.sources.line(function.span).unwrap_or(1);
                let comment = comment_above(module.text, line);
                functions.push(FunctionEntry {
                    name: function.name.clone(),
                    signature: signature(&program.types, function),
                    declaration: declaration(&program.types, function),
                    documentation: paragraphs(comment.iter().copied().filter(|line| bound_in(line).is_none())),
                    bound: comment.iter().find_map(|line| bound_in(line)).map(str::to_owned),
                    cost: cost(&program.types, shader, id),
                });
            }
        }
    }
    Entry { module, header: Header::of(module.text), notes: notes(module.text), functions }
}

/// The entries of all modules, by name.
pub fn entries() -> Vec<Entry> {
    modules().iter().map(entry).collect()
}

/// The name and the types of the parameters.
pub(super) fn signature(types: &Types, function: &Function) -> String {
    let names: Vec<String> = function.params().iter().map(|param| types.name(param.ty)).collect();
    format!("{}({})", function.name, names.join(","))
}

fn declaration(types: &Types, function: &Function) -> String {
    let params: Vec<String> =
        function.params().iter().map(|param| format!("{} {}", types.name(param.ty), param.name)).collect();
    format!("{} {}({})", types.name(function.ret), function.name, params.join(", "))
}

/// The comment that ends on the line above `line`, counted from 1: its lines, without slashes.
fn comment_above(text: &str, line: u32) -> Vec<&str> {
    let above: Vec<&str> = text.lines().take(line.saturating_sub(1) as usize).collect();
    let start = above.iter().rposition(|line| !line.starts_with("//")).map_or(0, |index| index + 1);
    above.iter().skip(start).map(|line| line.trim_start_matches("//")).collect()
}

/// The bound that a line of a comment states.
fn bound_in(line: &str) -> Option<&str> {
    line.trim().strip_prefix("bound:").map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::entries;

    #[test]
    fn every_module_says_all_of_itself_and_every_function_is_documented() {
        for entry in entries() {
            let (header, name) = (entry.header, entry.module.name);
            assert_eq!(header.name, name);
            for field in [header.kind, header.equation, header.source, header.stability] {
                assert!(!field.is_empty(), "{name} lacks a key: {header:?}");
            }
            assert_eq!(entry.functions.is_empty(), header.kind == "interface", "{name}");
            for function in &entry.functions {
                assert!(!function.documentation.is_empty(), "{name}: {} is not documented", function.signature);
            }
        }
    }

    #[test]
    fn every_parameter_is_documented_where_it_first_comes() {
        let mut missing = Vec::new();
        for entry in entries().iter().filter(|entry| !matches!(entry.header.kind, "reference" | "helper")) {
            let documented: String = entry.functions.iter().map(|function| function.documentation.as_str()).collect();
            for function in &entry.functions {
                let params =
                    function.declaration.split_once('(').map_or("", |(_, params)| params.trim_end_matches(')'));
                for (_, param) in params.split(", ").filter_map(|param| param.rsplit_once(' ')) {
                    let word = |text: &str| text.split(|c: char| !c.is_alphanumeric()).any(|word| word == param);
                    if !word(&documented) {
                        missing.push(format!("{}: `{param}` of {}", entry.module.name, function.declaration));
                    }
                }
            }
        }
        assert!(missing.is_empty(), "{missing:#?}");
    }
}

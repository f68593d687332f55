//! Modules of the library as WGSL, for hosts whose shaders are written in it.
//!
//! *In:* a module, or all of them. *Out:* one text without an entry point: the functions of the module with their comments, and what
//! they call and use. *Holds:* a function has its name in GLSL; overloads, which WGSL does not have, have the types of their
//! parameters behind it: `sdfBox(vec2,vec2)` is `sdfBox_vec2_vec2`. What is overloaded in one module has these names in all texts.

use super::catalogue::{entries, signature};
use super::{Embedded, Module, SHOWN, is_embedded};
use glisten_emit::{Conventions, Emitted, emit_functions};
use glisten_front::diagnostic::write::human;
use glisten_front::hir::{Function, FunctionId, Shader, Stage, Types};
use glisten_front::source::SourceMap;
use glisten_front::{Compilation, Compiler, Options, Program, Source};
use std::collections::{BTreeMap, BTreeSet};

/// The names of functions that have overloads.
pub struct Overloads(BTreeSet<String>);

impl Overloads {
    /// Those of the library.
    pub fn of_the_library() -> Self {
        let mut known: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for function in entries().into_iter().flat_map(|entry| entry.functions) {
            known.entry(function.name).or_default().insert(function.signature);
        }
        Self(known.into_iter().filter(|(_, signatures)| signatures.len() > 1).map(|(name, _)| name).collect())
    }

    /// The name of a function in WGSL.
    fn name(&self, types: &Types, function: &Function) -> String {
        if self.0.contains(&function.name) { spelled(&signature(types, function)) } else { function.name.clone() }
    }
}

/// A signature as a name: `safeLimit(vec3)` as `safeLimit_vec3`.
fn spelled(signature: &str) -> String {
    let words = signature.split(|letter: char| !letter.is_alphanumeric());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
}

/// Modules as one text of WGSL, which is that of the file `name`.
///
/// # Errors
/// What WGSL cannot represent, as text.
pub fn wgsl(name: &str, modules: &[Module], overloads: &Overloads, options: &Options) -> Result<String, String> {
    let Compilation { program, sources, diagnostics, .. } =
        Compiler::new(options.clone()).with_includes(Embedded).compile(&[shader(name, modules)]);
    let Some(program) = program else { return Err(human(&sources, &diagnostics, false)) };
    let program = with_names(program, overloads);
    let mut text = String::new();
    for shader in &program.stages {
        let wanted = own(shader, modules, &sources);
        let ids: Vec<FunctionId> = wanted.iter().map(|(id, _)| *id).collect();
        let emitted = emit_functions(&program, shader.stage, &ids, &Conventions::default(), Some(&sources));
        if let Emitted::Text(own) = emitted.map_err(|found| human(&sources, &found, false))? {
            text.push_str(&own);
        }
        missing(&text, &wanted)?;
    }
    Ok(text)
}

/// A shader that includes modules and does nothing. The comment of a single one is its own.
fn shader(name: &str, modules: &[Module]) -> Source {
    let comment: String = match modules {
        [one] => one.text.lines().take_while(|line| line.starts_with("//")).map(|line| format!("{line}\n")).collect(),
        _ => "// All modules of glisten's library of lighting models.\n".to_owned(),
    };
    let includes: String = modules.iter().map(|module| format!("#include <glisten/{}.glsl>\n", module.name)).collect();
    let text = format!(
        "#version 150\n{comment}\n#extension GL_ARB_shading_language_include : require\n{includes}void main() {{}}\n"
    );
    Source { name: name.to_owned(), text: text.into(), stage: Stage::Fragment }
}

/// The program with a name for each overload.
fn with_names(mut program: Program, overloads: &Overloads) -> Program {
    for shader in &mut program.stages {
        for function in &mut shader.functions {
            function.name = overloads.name(&program.types, function);
        }
    }
    program
}

/// The functions of these modules: all but those of others that they include. A name that a macro makes is in no module's text.
fn own<'s>(shader: &'s Shader, modules: &[Module], sources: &SourceMap) -> Vec<(FunctionId, &'s Function)> {
    let files: BTreeSet<String> = modules.iter().map(|module| format!("{SHOWN}{}.glsl", module.name)).collect();
    let is_own = |function: &Function| {
        let file = sources.file_of(function.span).map_or("", |file| sources.file(file).name());
        !is_embedded(file) || files.contains(file)
    };
    let has_text = |id: FunctionId, function: &Function| Some(id) != shader.main && function.body.is_some();
    shader.functions().filter(|(id, function)| has_text(*id, function) && is_own(function)).collect()
}

/// Refuses a text in which a function is not there or has another name.
fn missing(text: &str, wanted: &[(FunctionId, &Function)]) -> Result<(), String> {
    match wanted.iter().find(|(_, function)| !text.contains(&format!("\nfn {}(", function.name))) {
        Some((_, function)) => Err(format!("error: WGSL has no function of the name `{}`\n", function.name)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::modules;
    use super::{Options, Overloads, spelled, wgsl};

    #[test]
    fn a_signature_is_a_name() {
        assert_eq!(spelled("safeLimit(vec3)"), "safeLimit_vec3");
        assert_eq!(spelled("f(float[3],Light)"), "f_float_3_Light");
        assert_eq!(spelled("f()"), "f");
    }

    #[test]
    fn an_overload_has_its_name_where_its_module_is_only_included() {
        let overloads = Overloads::of_the_library();
        let module = modules().iter().find(|module| module.name == "lights").expect("it is there");
        let text = wgsl("lights.glsl", &[*module], &overloads, &Options::default()).expect("WGSL has it");
        assert!(text.contains("fn illumination_vec3_vec3_vec3_float_float("), "{text}");
        assert!(text.contains("fn lightVector("), "{text}");
    }

    #[test]
    fn a_text_that_wgsl_does_not_have_is_an_error() {
        let safe = modules().iter().find(|module| module.name == "safe").expect("it is there");
        let defines = vec![("safeUnit".to_owned(), "loop".to_owned())];
        let options = Options { defines, ..Options::default() };
        let overloads = Overloads::of_the_library();
        let error = wgsl("safe.glsl", &[*safe], &overloads, &options).expect_err("a word of WGSL");
        assert!(error.contains("no function of the name `loop`"), "{error}");
    }
}

//! [`Plan`]: the names that the texts of a program get, decided for all of them together, so that its stages still fit.
//!
//! *In:* all texts of a program, with those that they include. *Out:* the new name of each output, attribute, varying and
//! uniform that was built in, and of each name that means something else today. *Holds:* a new name occurs in no text.

use super::names::FUNCTIONS;
use super::tokens::{closing, tokens};
use super::uses::{declared_variables, hiding_variables, keyword_uses, layout_macros, macros_alone};
use glisten_front::Stage;
use glisten_front::builtin::constants::{CONSTANTS, Constant};
use glisten_front::builtin::fixed::{FIXED, FixedRow, FixedType, STRUCTS};
use glisten_front::builtin::functions;
use glisten_front::language::{Feature, Profile, Storage, Types, Version};
use glisten_front::link::Program;
use glisten_front::source::Span;
use glisten_front::syntax::keywords;
use std::collections::{BTreeMap, BTreeSet};

/// The language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// `#version 150`.
    Core150,
    /// `#version 330`.
    Core330,
    /// `#version 330` that is read by the rules of Vulkan, too.
    Both330,
    /// `#version 450`.
    Core450,
    /// `#version 460`.
    Core460,
    /// `#version 300 es`.
    Es300,
    /// `#version 450` by the rules of GL_KHR_vulkan_glsl.
    Vulkan,
}

impl Target {
    /// All targets, each with its word in options.
    pub const ALL: [(&'static str, Self); 6] = [
        ("150", Self::Core150),
        ("330", Self::Core330),
        ("450", Self::Core450),
        ("460", Self::Core460),
        ("300es", Self::Es300),
        ("vulkan", Self::Vulkan),
    ];

    /// The `#version` line.
    pub fn version_line(self) -> &'static str {
        match self {
            Self::Core150 => "#version 150",
            Self::Core330 => "#version 330 core",
            Self::Both330 => "#version 330",
            Self::Core450 => "#version 450 core",
            Self::Core460 => "#version 460 core",
            Self::Es300 => "#version 300 es",
            Self::Vulkan => "#version 450",
        }
    }

    /// Whether the language wants its `#version` in the first line (GLSL ES 3.00 §3.4).
    pub(super) fn begins_with_version(self) -> bool {
        self == Self::Es300
    }

    /// The number of the language.
    fn number(self) -> u16 {
        match self {
            Self::Core150 => 150,
            Self::Core330 | Self::Both330 => 330,
            Self::Core450 | Self::Vulkan => 450,
            Self::Core460 => 460,
            Self::Es300 => 300,
        }
    }

    /// The language.
    fn language(self) -> Version {
        version(self.number())
    }

    /// Whether a backslash joins lines.
    pub(super) fn joins_lines(self) -> bool {
        self.language().has(Feature::LineContinuation)
    }

    /// Whether inputs of fragment shaders may be `invariant` (up to GLSL 4.10; not in ES 3.00).
    pub(super) fn has_invariant_inputs(self) -> bool {
        self != Self::Es300 && self.number() < 420
    }

    /// Whether a semicolon alone is a declaration (GLSL 4.60 §9).
    pub(super) fn has_empty_declarations(self) -> bool {
        self == Self::Core460
    }

    /// Whether a word is one of the language, so that no name of a program can be that word.
    fn takes(self, word: &str) -> bool {
        keywords::is_taken(word, self.language()) || self.is_for_vulkan() && keywords::is_of_vulkan(word)
    }

    /// Whether lines that texts get have a word, so that no macro can have that name.
    fn is_written(self, word: &str) -> bool {
        match word {
            "layout" | "flat" => true,
            "highp" | "mediump" | "precision" => self == Self::Es300,
            _ => false,
        }
    }

    /// Whether Vulkan's rules hold.
    fn is_for_vulkan(self) -> bool {
        matches!(self, Self::Vulkan | Self::Both330)
    }

    /// Whether a text of a version is too new to be rewritten.
    pub(super) fn is_older_than(self, number: u16) -> bool {
        match self {
            // Desktop texts up to 1.50 have what ES 3.00 has.
            Self::Es300 => number != 300 && number > 150,
            _ => number > self.number(),
        }
    }

    /// The name of the language.
    pub(super) fn name(self) -> String {
        let es = if self == Self::Es300 { "ES " } else { "" };
        format!("{es}{}.{:02}", self.number() / 100, self.number() % 100)
    }
}

/// The language with a number: 100 and those from 300 to 320 are of ES, but for 330.
fn version(number: u16) -> Version {
    let profile = if matches!(number, 100 | 300 | 310 | 320) { Profile::Es } else { Profile::Core };
    Version { number, profile, span: Span::default() }
}

/// A text of a program.
#[derive(Clone, Copy, Debug)]
pub struct Text<'t> {
    /// The text.
    pub text: &'t str,
    /// The stage that reads it.
    pub stage: Stage,
    /// Whether it is a shader, and not only included by one.
    pub is_shader: bool,
    /// The number of its version: 110 for GLSL 1.10.
    pub version: u16,
}

impl Text<'_> {
    /// Whether its version is one of ES, which has precisions.
    pub(super) fn is_of_es(&self) -> bool {
        version(self.version).profile == Profile::Es
    }

    /// Whether a backslash joins lines in its version.
    pub(super) fn joins_lines(&self) -> bool {
        version(self.version).has(Feature::LineContinuation)
    }
}

/// Names without a counterpart: clipping by a vertex, and the inputs of EXT_geometry_shader4.
static REFUSED: &[&str] = &["gl_ClipVertex", "gl_PositionIn", "gl_VerticesIn"];

/// The old outputs of fragment shaders.
const OUTPUTS: [&str; 2] = ["gl_FragColor", "gl_FragData"];

/// A declaration that a stage gets.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Declared {
    stage: Stage,
    line: String,
}

/// The new names of a program.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The language to write.
    pub target: Target,
    /// Whether only names change: the texts are newer than the target, and have its words.
    pub(super) has_names_only: bool,
    /// The new text of an old word in a stage.
    words: BTreeMap<(Stage, String), String>,
    declarations: Vec<Declared>,
    /// Sentences for the author of the host.
    pub notes: Vec<String>,
    /// Names that the target has no counterpart for.
    pub refused: Vec<&'static str>,
}

/// The name without `gl_`, as a variable is written.
fn plain_name(name: &str) -> String {
    let name = name.strip_prefix("gl_").unwrap_or(name);
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}", first.to_lowercase(), letters.as_str()))
}

impl Plan {
    /// The plan for the texts of one program.
    pub fn new(texts: &[Text<'_>], target: Target) -> Self {
        Self::with_words(texts, target, &BTreeSet::new())
    }

    /// The plan for the texts of a program; new names are none of these words.
    pub fn with_words(texts: &[Text<'_>], target: Target, words: &BTreeSet<String>) -> Self {
        let mut planner = Planner::new(texts, target, words);
        planner.taken(texts);
        planner.variables(texts);
        planner.constants();
        planner.fixed(texts);
        planner.outputs(texts);
        planner.plan
    }

    /// The same plan without the output that stands for `gl_FragColor`, if a program by the plan does not write it and declares
    /// others: then the name stands only in a branch for older versions.
    pub fn without_spare_output(&self, program: &Program) -> Option<Self> {
        let stage = Stage::Fragment;
        let new = self.word(stage, OUTPUTS[0])?;
        let new = new.split('[').next().unwrap_or(new);
        let globals = program.stage(stage).map(|shader| shader.globals.as_slice()).unwrap_or_default();
        let outputs = || globals.iter().filter(|global| global.storage == Storage::Out && global.builtin.is_none());
        let is_spare = outputs().any(|global| global.name == new && !global.used);
        if !is_spare || outputs().all(|global| global.name == new) {
            return None;
        }
        let mut plan = self.clone();
        plan.words.retain(|(_, old), _| !OUTPUTS.contains(&old.as_str()));
        plan.declarations.retain(|declared| declared.stage != stage || !declared.line.starts_with("out "));
        Some(plan)
    }

    /// The plan for texts that are newer than the target: the names that the target takes change, and nothing else.
    pub fn of_names(texts: &[Text<'_>], target: Target, words: &BTreeSet<String>) -> Self {
        let mut planner = Planner::new(texts, target, words);
        planner.taken(texts);
        Self { has_names_only: true, ..planner.plan }
    }

    /// Whether it changes nothing.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty() && self.declarations.is_empty()
    }

    /// Whether a word of the texts is a keyword of the target, so that no member has it as its name.
    pub(super) fn is_keyword(&self, word: &str) -> bool {
        self.target.takes(word)
    }

    /// The new text of a word.
    pub(super) fn word(&self, stage: Stage, word: &str) -> Option<&str> {
        self.words.get(&(stage, word.to_owned())).map(String::as_str)
    }

    /// The declarations that a stage gets.
    pub(super) fn declarations(&self, stage: Stage) -> impl Iterator<Item = &str> {
        self.declarations.iter().filter(move |declared| declared.stage == stage).map(|declared| declared.line.as_str())
    }

    /// The names that come in place of what was built in.
    pub fn provided(&self) -> impl Iterator<Item = &str> {
        self.words.iter().filter(|((_, old), _)| old.starts_with("gl_")).map(|(_, new)| new.as_str())
    }

    /// The new name of an old one in any stage, for texts of the host such as scenes.
    pub fn renamed(&self, word: &str) -> Option<&str> {
        Stage::ALL.into_iter().find_map(|stage| self.word(stage, word))
    }
}

/// A plan in progress.
struct Planner<'t> {
    plan: Plan,
    /// The words of the program.
    own: BTreeSet<&'t str>,
    /// All words that no new name may be.
    used: BTreeSet<&'t str>,
    by_stage: BTreeSet<(Stage, &'t str)>,
    /// The structs that a stage has declared.
    structs: BTreeSet<(Stage, &'static str)>,
}

impl<'t> Planner<'t> {
    fn new(texts: &[Text<'t>], target: Target, words: &'t BTreeSet<String>) -> Self {
        let mut own: BTreeSet<&str> = BTreeSet::new();
        let mut by_stage: BTreeSet<(Stage, &str)> = BTreeSet::new();
        for text in texts {
            for token in tokens(text.text).iter().filter(|token| token.is_word()) {
                own.insert(token.text);
                by_stage.insert((text.stage, token.text));
            }
        }
        let plan = Plan {
            target,
            has_names_only: false,
            words: BTreeMap::new(),
            declarations: Vec::new(),
            notes: Vec::new(),
            refused: Vec::new(),
        };
        let used = own.iter().copied().chain(words.iter().map(String::as_str)).collect();
        Self { plan, own, used, by_stage, structs: BTreeSet::new() }
    }

    fn uses(&self, stage: Stage, word: &str) -> bool {
        self.by_stage.contains(&(stage, word))
    }

    /// A name that occurs nowhere.
    fn free(&self, name: &str) -> String {
        let taken = |name: &str| {
            self.used.contains(name)
                || self.plan.words.values().any(|other| other == name)
                || FUNCTIONS.contains(&name)
                || self.plan.target.takes(name)
        };
        let mut free = name.to_owned();
        while taken(&free) {
            free.push('_');
        }
        // Two underscores in a row are reserved.
        if free.contains("__") { format!("{name}{}", self.used.len()) } else { free }
    }

    fn replace(&mut self, stage: Stage, old: &str, new: &str) {
        self.plan.words.insert((stage, old.to_owned()), new.to_owned());
    }

    fn declare(&mut self, stage: Stage, line: String) {
        self.plan.declarations.push(Declared { stage, line });
    }

    /// Names of the program that mean something else in the target.
    fn taken(&mut self, texts: &[Text<'_>]) {
        let target = self.plan.target;
        let is_old = texts.iter().all(|text| text.version < 130);
        // ES 3.00 lets nobody define a built-in function again (§6.1).
        let keeps_own = target.is_for_vulkan() || target == Target::Es300;
        let mut declared = declared_functions(texts, is_old, keeps_own);
        declared.extend(hiding_variables(|| texts.iter().map(|text| text.text)));
        if target == Target::Es300 {
            declared.extend(globals_named_as_functions(texts));
        }
        let is_function = |name: &str| declared.contains(name);
        let is_new_word = |name: &str| {
            // A function of older versions has another name now.
            target.takes(name)
                && functions::named(name).is_empty()
                && texts.iter().all(|text| !keywords::is_taken(name, version(text.version)))
        };
        let all = || texts.iter().map(|text| text.text);
        let as_keywords = keyword_uses(all());
        let as_macros = macros_alone(all());
        let is_kept = |name: &&str| {
            as_keywords.contains(*name) || as_macros.contains(*name) && !target.is_written(name) && !is_function(name)
        };
        let as_layouts = if target.is_for_vulkan() { layout_macros(all()) } else { BTreeSet::new() };
        let names: Vec<&str> = self.own.iter().copied().filter(|name| is_function(name) || is_new_word(name)).collect();
        let names: Vec<&str> = names.into_iter().filter(|name| !is_kept(name)).collect();
        for name in names.into_iter().chain(as_layouts) {
            let new = self.free(name);
            Stage::ALL.into_iter().for_each(|stage| self.replace(stage, name, &new));
            let is_called = texts.iter().any(|text| defines_function(text.text, name));
            let host = if is_called { "" } else { "; the host may name it, too" };
            self.plan.notes.push(format!("`{name}` means something else now, and is called `{new}`{host}"));
        }
    }

    /// Variables of the program under the names of old lookups: they keep them where they may.
    fn variables(&mut self, texts: &[Text<'_>]) {
        for name in declared_variables(texts.iter().map(|text| text.text)) {
            let new = if self.plan.target.takes(name) { self.free(name) } else { name.to_owned() };
            Stage::ALL.into_iter().for_each(|stage| self.replace(stage, name, &new));
            if new != name {
                self.plan.notes.push(format!("`{name}` is a type now, and the variable is called `{new}`"));
            }
        }
    }

    /// Constants that the target does not have: their values.
    fn constants(&mut self) {
        let language = self.plan.target.language();
        let is_gone = |row: &&Constant| self.own.contains(row.name) && !row.availability.in_version(language);
        for row in CONSTANTS.iter().filter(is_gone).collect::<Vec<_>>() {
            Stage::ALL.into_iter().for_each(|stage| self.replace(stage, row.name, &row.value.to_string()));
        }
    }

    /// Variables of the fixed-function pipeline.
    fn fixed(&mut self, texts: &[Text<'_>]) {
        self.plan.refused.extend(REFUSED.iter().filter(|name| self.own.contains(*name)));
        if self.own.contains("gl_BackColor") || self.own.contains("gl_BackSecondaryColor") {
            let note =
                "the fragment shader reads the front color alone; for two sides, let it choose by `gl_FrontFacing`";
            self.plan.notes.push(note.to_owned());
        }
        if self.own.contains("gl_FrontColor") || self.own.contains("gl_FrontSecondaryColor") {
            let note = "OpenGL clamps the colors of the vertex stage to [0, 1], and a varying is not clamped; add `clamp` \
                        where they may leave it";
            self.plan.notes.push(note.to_owned());
        }
        let types = Types::new();
        let units = units(texts);
        let mut names: BTreeMap<String, String> = BTreeMap::new();
        for stage in Stage::ALL {
            let rows = FIXED.iter().filter(|row| row.availability.stages.has(stage) && self.uses(stage, row.name));
            for row in rows.collect::<Vec<_>>() {
                let old = varying_name(row, stage);
                let new = names.get(old).cloned().unwrap_or_else(|| self.free(&plain_name(old)));
                self.declare_fixed(row, stage, &new, &types, units);
                self.replace(stage, row.name, &new);
                names.insert(old.to_owned(), new);
            }
        }
        self.transform(&mut names, &types);
        if !names.is_empty() {
            let list: Vec<String> = names.iter().map(|(old, new)| format!("`{old}` is `{new}`")).collect();
            self.plan.notes.push(format!("the host provides what was built in: {}", list.join(", ")));
        }
    }

    fn declare_fixed(&mut self, row: &FixedRow, stage: Stage, new: &str, types: &Types, units: u32) {
        let (ty, array) = match row.ty {
            FixedType::Plain(ty) => (types.name(ty), String::new()),
            FixedType::Array(ty, size) => {
                let size = if row.name == "gl_TexCoord" { units } else { size };
                (types.name(ty), format!("[{size}]"))
            }
            FixedType::Struct(name) => (self.structure(stage, name, types), String::new()),
            FixedType::Structs(name, size) => (self.structure(stage, name, types), format!("[{size}]")),
        };
        let storage = match row.storage {
            Storage::In => "in",
            Storage::Out => "out",
            _ => "uniform",
        };
        self.declare(stage, format!("{storage} {ty} {new}{array};"));
    }

    /// The name of a struct, which the stage declares once.
    fn structure(&mut self, stage: Stage, old: &'static str, types: &Types) -> String {
        let new = old.strip_prefix("gl_").unwrap_or(old).to_owned();
        let members = STRUCTS.iter().find(|row| row.0 == old).map(|row| row.1).unwrap_or_default();
        if self.structs.insert((stage, old)) {
            let members: Vec<String> =
                members.iter().map(|(name, ty)| format!("{} {name};", types.name(*ty))).collect();
            self.declare(stage, format!("struct {new} {{ {} }};", members.join(" ")));
            self.replace(stage, old, &new);
        }
        new
    }

    /// `ftransform()`: the position that the fixed-function pipeline computes.
    fn transform(&mut self, names: &mut BTreeMap<String, String>, types: &Types) {
        if !self.uses(Stage::Vertex, "ftransform") {
            return;
        }
        let mut parts = Vec::new();
        for old in ["gl_ModelViewProjectionMatrix", "gl_Vertex"] {
            let row = FIXED.iter().find(|row| row.name == old);
            let known = self.plan.word(Stage::Vertex, old).map(str::to_owned);
            let new = known.clone().or(names.get(old).cloned()).unwrap_or_else(|| self.free(&plain_name(old)));
            if let Some(row) = row.filter(|_| known.is_none()) {
                self.declare_fixed(row, Stage::Vertex, &new, types, 1);
                self.replace(Stage::Vertex, old, &new);
            }
            names.insert(old.to_owned(), new.clone());
            parts.push(new);
        }
        self.replace(Stage::Vertex, "ftransform", &format!("({})", parts.join(" * ")));
    }

    /// `gl_FragColor` and `gl_FragData`.
    fn outputs(&mut self, texts: &[Text<'_>]) {
        // `gl_FragColor` of ES is `mediump`; other languages know no precisions.
        let precision = match self.plan.target {
            Target::Es300 if texts.iter().any(Text::is_of_es) => "mediump ",
            Target::Es300 => "highp ",
            _ => "",
        };
        let stage = Stage::Fragment;
        if self.uses(stage, "gl_FragData") {
            let name = self.free("fragData");
            let size = largest_index(texts, "gl_FragData").map_or(8, |largest| largest + 1);
            self.declare(stage, format!("out {precision}vec4 {name}[{size}];"));
            self.replace(stage, "gl_FragData", &name);
            self.replace(stage, "gl_FragColor", &format!("{name}[0]"));
        } else if self.uses(stage, "gl_FragColor") {
            let name = self.free("fragColor");
            self.declare(stage, format!("out {precision}vec4 {name};"));
            self.replace(stage, "gl_FragColor", &name);
        }
    }
}

/// The names of built-in functions that the texts give to something else: to anything, if later versions have the function, and to functions
/// of their own, if Vulkan's rules hold, by which no function has such a name.
fn declared_functions<'t>(texts: &[Text<'t>], is_old: bool, keeps_own: bool) -> BTreeSet<&'t str> {
    let mut found = BTreeSet::new();
    for text in texts {
        let all = tokens(text.text);
        for (index, token) in all.iter().enumerate().filter(|(_, token)| token.is_word()) {
            let before = index.checked_sub(1).and_then(|before| all.get(before));
            let follows_a_word =
                before.is_some_and(|before| before.is_word() && !["return", "else"].contains(&before.text));
            let has_arguments = all.get(index + 1).is_some_and(|next| next.text == "(");
            let is_taken = is_old && FUNCTIONS.contains(&token.text) && (follows_a_word || !has_arguments);
            let ends = || closing(&all, index + 1).and_then(|end| all.get(end + 1));
            let is_function = follows_a_word && has_arguments && ends().is_some_and(|next| next.text == "{");
            if is_taken || keeps_own && is_function && functions::is_known_for_vulkan(token.text) {
                found.insert(token.text);
            }
        }
    }
    found
}

/// The global variables with names of built-in functions, which ES 3.00 does not let them have (§6.1), and which no text calls.
fn globals_named_as_functions<'t>(texts: &[Text<'t>]) -> BTreeSet<&'t str> {
    let (mut found, mut called) = (BTreeSet::new(), BTreeSet::new());
    for text in texts {
        let all = tokens(text.text);
        let mut depth = 0_usize;
        for (index, token) in all.iter().enumerate() {
            match token.text {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth = depth.saturating_sub(1),
                name if token.is_word() && !functions::named(name).is_empty() => {
                    let next = all.get(index + 1).map_or("", |next| next.text);
                    if next == "(" {
                        called.insert(name);
                    } else if depth == 0 && [";", ",", "=", "["].contains(&next) {
                        found.insert(name);
                    }
                }
                _ => {}
            }
        }
    }
    found.retain(|name| !called.contains(name));
    found
}

/// The name of a variable for all stages: what a fragment shader reads as `gl_Color` is written as `gl_FrontColor`.
fn varying_name(row: &FixedRow, stage: Stage) -> &'static str {
    match (row.name, stage) {
        ("gl_Color", Stage::Fragment) => "gl_FrontColor",
        ("gl_SecondaryColor", Stage::Fragment) => "gl_FrontSecondaryColor",
        _ => row.name,
    }
}

/// The number of elements of `gl_TexCoord` that the stages use.
fn units(texts: &[Text<'_>]) -> u32 {
    largest_index(texts, "gl_TexCoord").map_or(8, |largest| largest + 1).min(8)
}

/// The largest index of an array, if all are literals; a size in a declaration counts as one less.
fn largest_index(texts: &[Text<'_>], name: &str) -> Option<u32> {
    let mut largest = 0;
    for text in texts {
        let tokens = tokens(text.text);
        for (index, _) in tokens.iter().enumerate().filter(|(_, token)| token.text == name) {
            let at = |offset: usize| tokens.get(index + offset).map(|token| token.text);
            match (at(1), at(2).and_then(|number| number.parse::<u32>().ok()), at(3)) {
                (Some("["), Some(number), Some("]")) if number < 8 => largest = largest.max(number),
                _ => return None,
            }
        }
    }
    Some(largest)
}

/// Whether a text defines or declares a function with a name: a word, the name, a parenthesis.
fn defines_function(text: &str, name: &str) -> bool {
    let all = tokens(text);
    all.windows(3).any(|words| {
        matches!(words, [ty, own, open] if own.text == name && open.text == "(" && ty.is_word() && ty.text != "return")
    })
}

#[cfg(test)]
mod tests {
    use super::{Plan, Target, Text, plain_name};
    use glisten_front::Stage;

    fn text(text: &str, stage: Stage) -> Text<'_> {
        Text { text, stage, is_shader: true, version: 110 }
    }

    #[test]
    fn stages_agree() {
        let vertex = text("gl_FrontColor = gl_Color; gl_TexCoord[1] = ftransform(); vec4 color;", Stage::Vertex);
        let fragment = text("gl_FragColor = gl_Color * gl_TexCoord[0]; // fragColor\nfloat texture;", Stage::Fragment);
        let plan = Plan::new(&[vertex, fragment], Target::Core150);
        assert_eq!(plan.word(Stage::Vertex, "gl_Color"), Some("color_"));
        assert_eq!(plan.word(Stage::Vertex, "gl_FrontColor"), plan.word(Stage::Fragment, "gl_Color"));
        assert_eq!(plan.word(Stage::Vertex, "ftransform"), Some("(modelViewProjectionMatrix * vertex)"));
        assert_eq!(plan.word(Stage::Fragment, "texture"), Some("texture_"));
        let lines: Vec<&str> = plan.declarations(Stage::Fragment).collect();
        assert_eq!(lines, ["in vec4 frontColor;", "in vec4 texCoord[2];", "out vec4 fragColor;"]);
        assert_eq!(plain_name("gl_ModelViewMatrix"), "modelViewMatrix");
    }

    #[test]
    fn variables_do_not_hide_what_is_called_in_place_of_old_lookups() {
        let plan = |code| Plan::new(&[Text { version: 130, ..text(code, Stage::Fragment) }], Target::Core330);
        let word = |code| plan(code).word(Stage::Fragment, "texture").map(str::to_owned);
        assert_eq!(word("uniform sampler2D texture; f(texture2D(texture, p));").as_deref(), Some("texture_"));
        assert_eq!(word("uniform sampler2D texture; f(texelFetch(texture, p, 0));"), None);
        assert_eq!(word("f(texture2D(s, p) + texture(s, p)); { sampler2D texture; }"), None);
    }

    #[test]
    fn words_that_later_versions_reserve_get_other_names() {
        let old = Text { version: 100, ..text("float patch, resource, centroid; s.patch", Stage::Fragment) };
        let plan = Plan::new(&[old], Target::Es300);
        assert_eq!(plan.word(Stage::Fragment, "patch"), Some("patch_"));
        assert_eq!(plan.word(Stage::Vertex, "resource"), Some("resource_"));
        let guarded =
            text("precision mediump float; flat in vec4 a; layout(location = 0) out vec4 c;", Stage::Fragment);
        let plan = Plan::new(&[guarded], Target::Es300);
        assert_eq!(["precision", "mediump", "flat", "layout"].map(|word| plan.word(Stage::Fragment, word)), [None; 4]);
        let block = text("layout(std140, shared) uniform B { vec4 a; };", Stage::Fragment);
        assert_eq!(Plan::new(&[block], Target::Core460).word(Stage::Fragment, "shared"), None);
        let plan = Plan::new(&[text("float centroid, row_major, sample, x;", Stage::Vertex)], Target::Core150);
        assert_eq!(plan.word(Stage::Vertex, "centroid"), Some("centroid_"));
        assert_eq!(plan.word(Stage::Vertex, "x"), None);
    }

    #[test]
    fn macros_with_names_of_keywords_stay() {
        let macros = "#define lowp\n#define flat\n#define patch\n#ifdef A\n#define sample 2.0\n#endif\n";
        let code = "float patch; void main() { gl_FragColor = vec4(sample); }";
        let plan = |target| Plan::new(&[text(&format!("{macros}{code}"), Stage::Fragment)], target);
        let words =
            ["lowp", "sample", "patch", "flat"].map(|word| plan(Target::Vulkan).word(Stage::Fragment, word).is_some());
        assert_eq!(words, [false, false, true, true]);
    }

    #[test]
    fn names_of_functions_that_es_has_are_no_globals() {
        let old = text(
            "uniform float round, sinh[2]; varying float cosh; float f(float tanh) { return cosh(tanh); }",
            Stage::Fragment,
        );
        let plan = Plan::new(&[Text { version: 130, ..old }], Target::Es300);
        let words = ["round", "sinh", "cosh", "tanh"].map(|word| plan.word(Stage::Vertex, word));
        assert_eq!(words, [Some("round_"), Some("sinh_"), None, None]);
        assert_eq!(Plan::new(&[Text { version: 130, ..old }], Target::Core450).word(Stage::Fragment, "round"), None);
    }

    #[test]
    fn constants_that_are_gone_are_their_values() {
        let old = text("for (int i = 0; i < gl_MaxLights; i++) { x[i] = gl_MaxDrawBuffers; }", Stage::Fragment);
        let plan = Plan::new(&[old], Target::Core150);
        assert_eq!(
            ["gl_MaxLights", "gl_MaxDrawBuffers"].map(|word| plan.word(Stage::Fragment, word)),
            [Some("8"), None]
        );
    }

    #[test]
    fn structs_are_declared_before_their_use() {
        let plan = Plan::new(&[text("gl_LightSource[0].position", Stage::Vertex)], Target::Core330);
        let lines: Vec<&str> = plan.declarations(Stage::Vertex).collect();
        assert!(lines[0].starts_with("struct LightSourceParameters {"), "{lines:?}");
        assert_eq!(lines[1], "uniform LightSourceParameters lightSource[8];");
    }
}

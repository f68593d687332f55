//! The language's own names, for people: what each is, in the version and stage of a text.
//!
//! *In:* a name, a version, a stage. *Out:* its declarations, its sentence, its section; lists of all names for completion.

use glisten_front::builtin::{constants, fixed, functions, sentences, variables};
use glisten_front::hir::{Stage, Storage, Types};
use glisten_front::index::View;
use glisten_front::language::{Extensions, NEVER, Version};
use glisten_front::syntax::keywords;
use glisten_front::syntax::token::TokenKind;

/// A built-in name.
pub(crate) struct Builtin {
    /// Its declarations.
    pub(crate) declarations: Vec<String>,
    /// Its kind.
    pub(crate) sentence: Option<&'static str>,
    /// Where the specification has it.
    pub(crate) section: &'static str,
}

/// A name for a list.
pub(crate) struct Listed {
    /// The name.
    pub(crate) name: &'static str,
    /// Its declaration.
    pub(crate) detail: String,
    /// Its kind.
    pub(crate) kind: ListedKind,
}

/// The kinds of names in the lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ListedKind {
    /// A function.
    Function,
    /// A variable.
    Variable,
    /// A constant.
    Constant,
    /// A type.
    Type,
    /// Another keyword.
    Keyword,
}

/// The extensions that a source enables anywhere.
pub(crate) fn extensions(view: &View) -> Extensions {
    view.ast.declarations.iter().fold(Extensions::empty(), |all, declaration| all | declaration.extensions)
}

fn storage(storage: Storage) -> &'static str {
    match storage {
        Storage::In => "in ",
        Storage::Out => "out ",
        Storage::Uniform => "uniform ",
        Storage::Const | Storage::Private => "",
    }
}

/// The prototypes of a function in a language; all of them if the language has none.
pub(crate) fn prototypes(
    name: &str,
    version: Version,
    extensions: Extensions,
    stage: Stage,
) -> Vec<&'static functions::Row> {
    let rows = functions::named(name);
    let here: Vec<_> = rows.iter().copied().filter(|row| row.availability.holds(version, extensions, stage)).collect();
    if here.is_empty() { rows.to_vec() } else { here }
}

/// The kind of a built-in name.
pub(crate) fn describe(name: &str, version: Version, stage: Stage) -> Option<Builtin> {
    let all = Extensions::all();
    let sentence = sentences::sentence(name);
    let rows = prototypes(name, version, Extensions::empty(), stage);
    if let Some(first) = rows.first() {
        let declarations = rows.iter().map(|row| row.prototype()).collect();
        return Some(Builtin { declarations, sentence, section: first.section });
    }
    let mut types = Types::new();
    if let Some(row) = variables::VARIABLES.iter().find(|row| row.name == name && row.availability.stages.has(stage)) {
        let ty = row.make_type(&mut types, version);
        let declaration = format!("{}{} {name}", storage(row.storage), types.name(ty));
        return Some(Builtin { declarations: vec![declaration], sentence, section: row.section });
    }
    if let Some(row) = constants::named(name, version, all) {
        let declaration = format!("const int {name} = {}", row.value);
        return Some(Builtin { declarations: vec![declaration], sentence, section: row.section });
    }
    let row = fixed::FIXED.iter().find(|row| row.name == name)?;
    let declaration = format!("{}{name}", storage(row.storage));
    let sentence = Some("A variable of the fixed-function pipeline.");
    Some(Builtin { declarations: vec![declaration], sentence, section: "§7" })
}

/// The meaning of a keyword.
pub(crate) fn keyword(word: &str) -> Option<String> {
    let row = keywords::TABLE.iter().find(|row| row.spelling == word)?;
    let kind = if row.kind == TokenKind::Type { "a type" } else { "a keyword" };
    let since = match row.keyword.desktop {
        NEVER => String::new(),
        since => format!(" since GLSL {}.{:02}", since / 100, since % 100),
    };
    Some(format!("`{word}`: {kind}{since}\n"))
}

/// All built-in names of a language and stage.
pub(crate) fn list(version: Version, extensions: Extensions, stage: Stage) -> Vec<Listed> {
    let mut names = Vec::new();
    for name in functions::names() {
        let mut rows = functions::named(name).iter().filter(|row| row.availability.holds(version, extensions, stage));
        if let Some(first) = rows.next() {
            let more = rows.count();
            let more = if more > 0 { format!(" (+{more})") } else { String::new() };
            names.push(Listed { name, detail: first.prototype() + &more, kind: ListedKind::Function });
        }
    }
    let mut types = Types::new();
    for row in variables::in_stage(version, extensions, stage) {
        let ty = row.make_type(&mut types, version);
        let detail = format!("{}{}", storage(row.storage), types.name(ty));
        names.push(Listed { name: row.name, detail, kind: ListedKind::Variable });
    }
    for row in fixed::FIXED.iter().filter(|row| row.availability.holds(version, extensions, stage)) {
        names.push(Listed { name: row.name, detail: storage(row.storage).to_owned(), kind: ListedKind::Variable });
    }
    for row in constants::CONSTANTS.iter().filter(|row| row.availability.in_language(version, extensions)) {
        names.push(Listed { name: row.name, detail: format!("const int = {}", row.value), kind: ListedKind::Constant });
    }
    for row in keywords::TABLE {
        let kind = match row.kind_in(version, extensions) {
            TokenKind::Ident | TokenKind::Reserved | TokenKind::Foreign => continue,
            TokenKind::Type | TokenKind::Void => ListedKind::Type,
            _ => ListedKind::Keyword,
        };
        names.push(Listed { name: row.spelling, detail: String::new(), kind });
    }
    names
}

//! `--depfile` and `--manifest`: what a build has read and written.
//!
//! *In:* the outputs of each program and the names of the texts it read. *Out:* a rule for Make and Ninja (`deps = gcc`), or
//! JSON. *Holds:* both name the same files in the same order, whatever `-j` is; the modules of the library and standard input
//! are no files.

use crate::digest::Digest;
use crate::files;
use crate::inputs::Group;
use crate::outputs::Output;
use glisten_front::source::SourceMap;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The files of one program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Made {
    /// The name of the program.
    pub(crate) program: String,
    /// The outputs by their paths.
    pub(crate) outputs: Vec<Output>,
    /// The files that were read.
    pub(crate) sources: Vec<String>,
}

impl Made {
    /// The outputs of a program in a folder.
    pub(crate) fn new(group: &Group, folder: &Path, outputs: &[Output], sources: &SourceMap) -> Self {
        let path = |name: &str| files::shown(&folder.join(name));
        let outputs = outputs.iter().map(|(name, content)| (path(name), content.clone())).collect();
        Self { program: group.name.clone(), outputs, sources: files_read(group, sources) }
    }
}

/// The names of the files that a program was read from.
pub(crate) fn files_read(group: &Group, sources: &SourceMap) -> Vec<String> {
    let standard_input = |name: &str| group.inputs.iter().any(|input| input.path.is_none() && input.name == name);
    let names = sources.files().map(|(_, file)| file.name());
    let is_file =
        |name: &&str| *name != SourceMap::COMMAND_LINE && !standard_input(name) && !glisten_library::is_embedded(name);
    names.filter(is_file).map(str::to_owned).collect()
}

/// One rule: all outputs, then all inputs and includes without repetitions.
pub(crate) fn make_rule(
    outputs: impl IntoIterator<Item = String>,
    sources: impl IntoIterator<Item = String>,
) -> Vec<u8> {
    let mut seen = BTreeSet::new();
    let mut words = |names: &mut dyn Iterator<Item = String>| {
        let fresh = names.filter(|name| seen.insert(name.clone()));
        fresh.map(|name| make_word(&files::bytes_of_name(&name))).collect::<Vec<_>>().join(&b' ')
    };
    let outputs = words(&mut outputs.into_iter());
    [&outputs, &b": "[..], &words(&mut sources.into_iter()), b"\n"].concat()
}

/// A file name, which need not be UTF-8, as a word of a Make rule.
fn make_word(name: &[u8]) -> Vec<u8> {
    let mut word = Vec::with_capacity(name.len());
    for byte in name {
        match byte {
            b'$' => word.push(b'$'),
            b'#' | b' ' => word.push(b'\\'),
            // On Windows it is the colon of a drive.
            b':' if cfg!(not(windows)) => word.push(b'\\'),
            _ => {}
        }
        word.push(*byte);
    }
    word
}

#[derive(Serialize)]
struct Manifest<'a> {
    glisten: &'static str,
    arguments: Vec<String>,
    outputs: Vec<ManifestOutput<'a>>,
}

#[derive(Serialize)]
struct ManifestOutput<'a> {
    file: &'a str,
    program: &'a str,
    sha256: Digest,
    bytes: usize,
    sources: Vec<ManifestSource<'a>>,
}

#[derive(Clone, Serialize)]
struct ManifestSource<'a> {
    file: &'a str,
    sha256: Option<Digest>,
}

/// The manifest: for each output the program, the digest, and the sources with theirs.
pub(crate) fn manifest(made: &[Made]) -> String {
    let mut digests: BTreeMap<&str, Option<Digest>> = BTreeMap::new();
    for name in made.iter().flat_map(|made| &made.sources) {
        let digest = || files::read(name, &files::path_of_name(name)).ok().map(|bytes| Digest::of(&bytes));
        digests.entry(name).or_insert_with(digest);
    }
    let mut seen = BTreeSet::new();
    let mut outputs = Vec::new();
    for one in made {
        let mut known = BTreeSet::new();
        let names = one.sources.iter().filter(|name| known.insert(name.as_str()));
        let source = |name: &'_ String| digests.get_key_value(name.as_str());
        let sources = names.filter_map(source).map(|(file, sha256)| ManifestSource { file, sha256: *sha256 });
        let sources: Vec<ManifestSource<'_>> = sources.collect();
        for (file, content) in one.outputs.iter().filter(|(file, ..)| seen.insert(file)) {
            let (program, sources) = (&one.program, sources.clone());
            outputs.push(ManifestOutput { file, program, sha256: content.digest(), bytes: content.len(), sources });
        }
    }
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let arguments = without_jobs(words);
    let manifest = Manifest { glisten: env!("CARGO_PKG_VERSION"), arguments, outputs };
    serde_json::to_string_pretty(&manifest).expect("names and numbers are always JSON") + "\n"
}

/// Arguments without the number of threads, on which no output depends.
fn without_jobs(words: impl Iterator<Item = String>) -> Vec<String> {
    let (mut kept, mut is_number) = (Vec::new(), false);
    for word in words {
        let names_jobs = word == "-j" || word == "--jobs";
        let holds_jobs = word.starts_with("--jobs=") || word.starts_with("-j") && !word.starts_with("--");
        if !is_number && !names_jobs && !holds_jobs {
            kept.push(word);
        }
        is_number = names_jobs && !is_number;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::{make_rule, without_jobs};

    #[test]
    fn the_number_of_threads_is_no_argument() {
        for words in
            ["compile a -j2 b", "compile a -j 2 b", "compile --jobs 2 a b", "--jobs=2 compile a b", "compile a b"]
        {
            let words = words.split(' ').map(str::to_owned);
            assert_eq!(without_jobs(words), ["compile", "a", "b"]);
        }
    }

    #[test]
    fn make_words_are_escaped() {
        let rule = make_rule(["a b$c#d".to_owned()], ["x".to_owned(), "y".to_owned(), "x".to_owned()]);
        assert_eq!(rule, b"a\\ b$$c\\#d: x y\n");
        if !cfg!(windows) {
            assert_eq!(make_rule(["a:b".to_owned()], ["c:d/e".to_owned()]), b"a\\:b: c\\:d/e\n");
        }
    }
}

//! Sources that nobody wrote: the tokens of the fixtures, mixed up. The front end, the lint rules and the writers must take
//! each of them: no panic, no internal error, no overflow of a stack of 2 MiB, and an end in time.
//!
//! `MUTATED_CASES=20000 cargo test -p glisten-emit --test mutated` runs more than the bounded number of cases, and with
//! `MUTATED_FIXTURES=chosen` only those of fixtures whose paths contain the word.

use glisten_emit::{Conventions, GlslVersion, Target, emit};
use glisten_front::diagnostic::codes::general;
use glisten_front::source::Completion;
use glisten_front::{Compiler, Options, Source, Stage, lint};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// A fixture as tokens; white space and line ends are tokens, too.
struct Fixture {
    path: String,
    stage: Stage,
    tokens: Vec<String>,
}

static FIXTURES: LazyLock<Vec<Fixture>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = vec![root];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("the fixtures are there");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable entry").path()).collect();
        paths.sort();
        folders.extend(paths.iter().filter(|path| path.is_dir()).cloned());
        found.extend(paths.iter().filter_map(|path| fixture(path)));
    }
    found
});

/// The fixtures whose tokens are mixed up.
static CHOSEN: LazyLock<Vec<&Fixture>> = LazyLock::new(|| {
    let word = std::env::var("MUTATED_FIXTURES").unwrap_or_default();
    FIXTURES.iter().filter(|fixture| fixture.path.contains(&word)).collect()
});

fn fixture(path: &Path) -> Option<Fixture> {
    let stage = match path.extension()?.to_str()? {
        "vert" => Stage::Vertex,
        "geom" => Stage::Geometry,
        "frag" => Stage::Fragment,
        _ => return None,
    };
    let text = std::fs::read_to_string(path).ok().filter(|text| text.len() < 6000)?;
    Some(Fixture { path: path.to_string_lossy().into_owned(), stage, tokens: tokens(&text) })
}

fn tokens(text: &str) -> Vec<String> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut list: Vec<String> = Vec::new();
    let mut was_word = false;
    for c in text.chars() {
        match list.last_mut().filter(|_| was_word && is_word(c)) {
            Some(last) => last.push(c),
            None => list.push(c.to_string()),
        }
        was_word = is_word(c);
    }
    list
}

/// Texts that reach limits, and what the versions differ in.
const HOSTILE: &[&str] = &[
    "0",
    "-1",
    "1u",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "1e39",
    "1e-50",
    ".",
    "[",
    "]",
    "(",
    ")",
    "{",
    "}",
    ";",
    ",",
    "=",
    "?",
    ":",
    "~",
    "%",
    "<<",
    ">>",
    "/ 0",
    "% 0",
    "<< 40",
    "[2147483647]",
    "[65536][65536]",
    "[0]",
    "[-1]",
    "[]",
    "gl_TexCoord[99999999]",
    "gl_TexCoord[i]",
    "gl_FragData[7]",
    "gl_ClipDistance[8]",
    "gl_LightSource[8].position",
    "gl_ModelViewMatrix",
    "ftransform()",
    "gl_FrontColor",
    "gl_in[5]",
    "gl_PerVertex",
    "\n#version 100\n",
    "\n#version 110\n",
    "\n#version 120\n",
    "\n#version 300 es\n",
    "\n#version 320 es\n",
    "\n#version 460\n",
    "\n#version 150 compatibility\n",
    "\n#extension GL_EXT_gpu_shader4 : enable\n",
    "\n#extension GL_ARB_enhanced_layouts : enable\n",
    "\n#extension all : warn\n",
    "\n#if 1\n",
    "\n#if (\n",
    "\n#elif 1 / 0\n",
    "\n#else\n",
    "\n#endif\n",
    "\n#define a a a\n",
    "\n#define f(x) x f(x) x\n",
    "\n#undef f\n",
    "f(f(f(",
    "##",
    "\\\n",
    "\n#line 2147483647\n",
    "\n#pragma import_defines(A, B)\n",
    "\n#pragma STDGL invariant(all)\n",
    "\n#include \"x\"\n",
    "layout(location = 2147483647) ",
    "layout(location = 4294967295) ",
    "layout(location = 0, component = 3) ",
    "layout(location = 31) ",
    "layout(offset = 4294967280) ",
    "layout(offset = 65520) ",
    "layout(align = 2147483648) ",
    "layout(align = 0) ",
    "layout(std140) ",
    "layout(binding = 4294967295) ",
    "layout(max_vertices = 4294967295) out;",
    "layout(index = 1) ",
    "layout(row_major) ",
    "uniform ",
    "in ",
    "out ",
    "attribute ",
    "varying ",
    "const ",
    "flat ",
    "invariant ",
    "precise ",
    "centroid ",
    "sample ",
    "sampler2D s[3];",
    "[i]",
    "[int(gl_FragCoord.x)]",
    "gl_SampleMaskIn[i]",
    "gl_SampleID",
    "textureGatherOffset(",
    "\n#extension GL_ARB_gpu_shader5 : enable\n",
    "\n#pragma unroll_loop_start\n",
    "for ( int i = 0; i < 3; i ++ ) {",
    "}\n#pragma unroll_loop_end\n",
    "UNROLLED_LOOP_INDEX",
    "precision mediump float;",
    "lowp ",
    "struct S { S s; };",
    "struct T { float a[3]; };",
    "float[2](1.0, 2.0)",
    "{ 1.0, 2.0 }",
    "{ { 1 }, 2 }",
    ".xxxx",
    ".length()",
    "switch (1) { case 1: }",
    "discard;",
    "return;",
    "for (;;) ",
    "while (true) ",
    "do ",
    "main",
    "void main() {}",
    "sampler2D ",
    "uint ",
    "mat4x3 ",
    "bvec2 ",
    "texture(",
    "textureGather(",
    "frexp(",
    "bitfieldExtract(",
    "dFdx(",
    "EmitVertex();",
    "/*",
    "*/",
    "//",
    "\u{fffd}",
    "\0",
];

/// One change of a text.
#[derive(Clone, Debug)]
enum Change {
    Remove(prop::sample::Index, usize),
    Insert(prop::sample::Index, usize),
    Replace(prop::sample::Index, usize),
    Swap(prop::sample::Index, prop::sample::Index),
    /// Puts a piece of another fixture in.
    Graft(prop::sample::Index, prop::sample::Index, prop::sample::Index, usize),
    Repeat(prop::sample::Index, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        (at(), 1..12_usize).prop_map(|(place, count)| Change::Remove(place, count)),
        (at(), 0..HOSTILE.len()).prop_map(|(place, text)| Change::Insert(place, text)),
        (at(), 0..HOSTILE.len()).prop_map(|(place, text)| Change::Replace(place, text)),
        (at(), at()).prop_map(|(a, b)| Change::Swap(a, b)),
        (at(), at(), at(), 1..60_usize)
            .prop_map(|(place, other, from, count)| Change::Graft(place, other, from, count)),
        (at(), 2..40_usize).prop_map(|(place, count)| Change::Repeat(place, count)),
    ]
}

fn apply(tokens: &mut Vec<String>, change: &Change) {
    if tokens.is_empty() {
        return;
    }
    let len = tokens.len();
    match change {
        Change::Remove(place, count) => {
            let start = place.index(len);
            tokens.drain(start..(start + count).min(len));
        }
        Change::Insert(place, text) => tokens.insert(place.index(len), HOSTILE[*text].to_owned()),
        Change::Replace(place, text) => tokens[place.index(len)] = HOSTILE[*text].to_owned(),
        Change::Swap(a, b) => tokens.swap(a.index(len), b.index(len)),
        Change::Graft(place, other, from, count) => {
            let donor = &FIXTURES[other.index(FIXTURES.len())].tokens;
            let start = from.index(donor.len().max(1)).min(donor.len());
            let piece = donor[start..(start + count).min(donor.len())].to_vec();
            let at = place.index(len);
            tokens.splice(at..at, piece);
        }
        Change::Repeat(place, count) => {
            let start = place.index(len);
            let piece: Vec<String> = tokens[start..(start + 8).min(len)].to_vec();
            let copies = piece.iter().cycle().take(piece.len() * count).cloned();
            tokens.splice(start..start, copies.collect::<Vec<_>>());
        }
    }
}

/// Compiles the stages of a program, and writes what is accepted for two targets.
fn take(shaders: &[(Stage, String)]) -> Result<(), String> {
    let source = |(stage, text): &(Stage, String)| Source {
        name: format!("mutated.{}", stage.name()),
        text: text.as_str().into(),
        stage: *stage,
    };
    let sources: Vec<Source> = shaders.iter().map(source).collect();
    let completion = Completion { unrolls: true, ..Completion::default() };
    let compilation = Compiler::new(Options { completion, ..Options::default() }).compile(&sources);
    let mut codes: Vec<(&str, String)> =
        compilation.diagnostics.iter().map(|finding| (finding.code.id, finding.message.clone())).collect();
    if let Some(program) = &compilation.program {
        codes.extend(
            lint::check(program, &compilation.sources).iter().map(|finding| (finding.code.id, finding.message.clone())),
        );
        let vulkan = Conventions { glsl_version: GlslVersion::Vulkan, ..Conventions::default() };
        let plain = [Target::Wgsl, Target::Spirv, Target::Glsl].map(|target| (target, Conventions::default()));
        let targets = plain.into_iter().chain([(Target::Glsl, vulkan)]);
        for (target, conventions) in targets {
            for (stage, _) in shaders {
                let errors = emit(program, *stage, target, &conventions).err().unwrap_or_default();
                codes.extend(errors.iter().map(|finding| (finding.code.id, finding.message.clone())));
            }
        }
    }
    match codes.iter().find(|(id, _)| *id == general::INTERNAL.id) {
        Some((_, message)) => Err(format!("internal error: {message}")),
        None => Ok(()),
    }
}

/// The stack of each case. A debug build needs more than a release build.
const STACK: usize = 2 << 20;
/// Far more than any case takes.
const LIMIT: Duration = Duration::from_secs(30);

fn cases() -> u32 {
    std::env::var("MUTATED_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(96)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mixed_up_sources_are_taken(
        chosen in any::<prop::sample::Index>(),
        changes in prop::collection::vec(change(), 1..8),
        partner in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let fixture = CHOSEN[chosen.index(CHOSEN.len())];
        let mut tokens = fixture.tokens.clone();
        changes.iter().for_each(|change| apply(&mut tokens, change));
        let mut shaders = vec![(fixture.stage, tokens.concat())];
        let partner = partner.map(|partner| &FIXTURES[partner.index(FIXTURES.len())]);
        if let Some(partner) = partner.filter(|partner| partner.stage != fixture.stage) {
            shaders.push((partner.stage, partner.tokens.concat()));
        }
        let begun = Instant::now();
        let shown: String = shaders.iter().map(|(stage, text)| format!("--- {}\n{text}\n", stage.name())).collect();
        let run = std::thread::Builder::new().stack_size(STACK).spawn(move || take(&shaders));
        let result = run.expect("a thread").join();
        prop_assert!(begun.elapsed() < LIMIT, "{:?} for\n{shown}", begun.elapsed());
        match result {
            Ok(Ok(())) => {}
            Ok(Err(message)) => prop_assert!(false, "{message}\n{shown}"),
            Err(_) => prop_assert!(false, "a panic for\n{shown}"),
        }
    }
}

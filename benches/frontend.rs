//! How fast the front-end is: parse alone, and parse with analysis and link, over the fixtures and over one text of
//! growing size. `cargo bench --bench frontend`; figures are bytes a second.
//!
//! Measured in user time on one core of a small virtual machine that others kept busy: parse 26 MB/s, the whole
//! front-end 15 MB/s, both the same from 10 KB to 5 MB. No function takes more than a ninth of it.

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use glisten::diagnostic::Diagnostics;
use glisten::hir::Stage;
use glisten::source::{NoIncludes, SourceMap};
use glisten::{Compiler, Options, Source, syntax};
use std::fs;
use std::path::Path;

fn main() {
    divan::main();
}

/// All programs of the fixtures: name, text and stage.
fn programs() -> Vec<(String, String, Stage)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/programs");
    let mut list: Vec<_> = fs::read_dir(folder)
        .expect("the fixtures are there")
        .filter_map(|entry| {
            let path = entry.expect("a folder entry").path();
            let stage = match path.extension()?.to_str()? {
                "vert" => Stage::Vertex,
                "frag" => Stage::Fragment,
                "geom" => Stage::Geometry,
                _ => return None,
            };
            Some((path.to_string_lossy().into_owned(), fs::read_to_string(&path).expect("readable"), stage))
        })
        .collect();
    list.sort();
    list
}

/// One shader of about `bytes` bytes: many functions of ordinary statements.
fn large(bytes: usize) -> String {
    let mut text = String::from("#version 150\nuniform vec4 tint;\nout vec4 color;\n");
    let mut number = 0;
    while text.len() < bytes {
        text.push_str(&format!(
            "// Weighs the light of step {number}.\nvec3 shade{number}(vec3 normal, vec3 light, float power) {{\n    \
             vec3 h = normalize(normal + light * 0.5);\n    float s = max(dot(normal, h), 0.0);\n    \
             for (int i = 0; i < 4; i++) {{\n        if (s > 0.25 && power > 1.0) s += pow(s, power) * {number}.0e-3;\n    \
             }}\n    return tint.rgb * s + vec3(0.1, 0.2, 0.3);\n}}\n"
        ));
        number += 1;
    }
    text.push_str("void main() { color = vec4(shade0(vec3(1.0), vec3(0.0, 1.0, 0.0), 8.0), 1.0); }\n");
    text
}

fn parse(name: &str, text: &str, stage: Stage) -> usize {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let file = sources.add(name, text).expect("room");
    let options = syntax::Options { stage, defines: Vec::new(), strict: false };
    let tree = syntax::parse(&mut sources, file, &options, &NoIncludes, &mut diagnostics);
    assert!(!diagnostics.has_errors(), "{name}");
    tree.exprs.len()
}

#[divan::bench]
fn parse_programs(bencher: Bencher<'_, '_>) {
    let programs = programs();
    let bytes: usize = programs.iter().map(|(_, text, _)| text.len()).sum();
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        for (name, text, stage) in &programs {
            black_box(parse(name, text, *stage));
        }
    });
}

#[divan::bench]
fn compile_programs(bencher: Bencher<'_, '_>) {
    let programs = programs();
    let bytes: usize = programs.iter().map(|(_, text, _)| text.len()).sum();
    let compiler = Compiler::new(Options::default());
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        for (name, text, stage) in &programs {
            let source = Source { name: name.clone(), text: text.as_str().into(), stage: *stage };
            black_box(compiler.compile(&[source]));
        }
    });
}

#[divan::bench(args = [10_000, 100_000, 1_000_000, 5_000_000], sample_count = 10)]
fn parse_large(bencher: Bencher<'_, '_>, bytes: usize) {
    let text = large(bytes);
    bencher.counter(BytesCount::new(text.len())).bench_local(|| black_box(parse("large.frag", &text, Stage::Fragment)));
}

#[divan::bench(args = [10_000, 100_000, 1_000_000], sample_count = 10)]
fn compile_large(bencher: Bencher<'_, '_>, bytes: usize) {
    let text = large(bytes);
    let compiler = Compiler::new(Options::default());
    bencher.counter(BytesCount::new(text.len())).bench_local(|| {
        let source = Source { name: "large.frag".into(), text: text.as_str().into(), stage: Stage::Fragment };
        black_box(compiler.compile(&[source]))
    });
}

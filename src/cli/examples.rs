//! Examples for the help text of each command.
//!
//! *In:* nothing. *Out:* the command line with examples. *Holds:* every command has examples, and every example is well-formed;
//! tests check both.

use clap::Command;
use std::ffi::OsString;

/// The examples of each command: a line, and what it does.
const EXAMPLES: &[(&str, &[(&str, &str)])] = &[
    (
        "lint",
        &[
            ("glisten lint shaders/", "all shaders of a folder, and the programs that they form"),
            (
                "glisten lint a.vert a.frag -D MAX_LIGHTS=4 -I include",
                "one program, with a macro and a folder of includes",
            ),
            ("glisten lint . --deny warnings --format github", "in CI: annotations on the changed lines"),
            ("glisten lint pack/ --engine iris", "sources that an engine completes"),
        ],
    ),
    (
        "compile",
        &[
            ("glisten compile a.vert a.frag -o out", "WGSL, SPIR-V and reflection of a program"),
            ("glisten compile a.vert a.frag -o out --target wgsl", "WGSL alone"),
        ],
    ),
    (
        "fmt",
        &[
            ("glisten fmt", "all sources of this folder"),
            ("glisten fmt --check shaders", "which files would change, in CI"),
            ("glisten fmt --diff a.frag", "what would change"),
            ("glisten fmt --stdin-filename a.frag -", "for editors"),
        ],
    ),
    (
        "lsp",
        &[
            ("glisten lsp", "what an editor starts: docs/editors.md"),
            (
                "glisten lsp -I include --engine minecraft",
                "with a search path and an engine, where glisten.toml has none",
            ),
        ],
    ),
    (
        "play",
        &[
            ("glisten play shaders", "the scenes of a folder, in a browser; the address is printed"),
            ("glisten play scene.toml --open", "one scene, and a browser that shows it"),
            ("glisten play --export page.html scene.toml", "a page to hand on"),
            ("glisten play shaders --export page.html --module play.wasm.gz", "a page that computes by itself"),
        ],
    ),
    (
        "cost",
        &[
            ("glisten cost a.vert a.frag", "operations on the shortest and the longest path, and the dearest lines"),
            (
                "glisten cost shaders --range lights=0..4 --format json",
                "with a limit for the rounds of loops, for scripts",
            ),
            ("glisten cost --measure", "how well costs rank the times of the library's scenes here"),
        ],
    ),
    (
        "reflect",
        &[
            ("glisten reflect a.vert a.frag", "attributes, uniforms, blocks, textures and outputs as a table"),
            ("glisten reflect a.vert a.frag --format json", "the same for a program"),
            ("glisten reflect a.vert a.frag --find light.position", "one name, as glGetUniformLocation"),
        ],
    ),
    (
        "rules",
        &[
            ("glisten rules", "all lint rules with their groups, levels and fixes"),
            ("glisten rules --group numerics --format json", "those of a group, for a script"),
        ],
    ),
    ("explain", &[("glisten explain E0301", "a code, with an example"), ("glisten explain --list", "all codes")]),
    (
        "render",
        &[
            ("glisten render scene.toml -o picture.png", "on the GPU"),
            ("glisten render scene.toml -o picture.npy --backend cpu", "by the reference in f64"),
        ],
    ),
    (
        "verify",
        &[
            ("glisten verify scene.toml", "the GPU's picture against the reference"),
            ("glisten verify scene.toml --difference off.png", "with a picture of the differences"),
            ("glisten verify scene.toml --evidence seen.png", "with a picture of how much was judged"),
            ("glisten verify scene.toml --with fragment=a.spv", "the code of another translator"),
        ],
    ),
    (
        "watch",
        &[
            ("glisten watch lint shaders", "the findings again after each change"),
            ("glisten watch render scene.toml -o picture.png", "the picture again after each change"),
        ],
    ),
    (
        "cache",
        &[
            ("glisten cache stats --cache .glisten-cache", "how much a cache holds"),
            ("glisten cache clean --cache .glisten-cache", "an empty cache"),
        ],
    ),
    (
        "snapshots",
        &[
            ("glisten snapshots review -o page.html", "the pictures of tests that wait for a decision"),
            ("glisten snapshots accept", "all of them become the stored ones"),
        ],
    ),
    (
        "specialize",
        &[
            ("glisten specialize scene.toml -o out", "programs of which nothing is left but what the scene needs"),
            ("glisten specialize scene.toml --check", "whether anything could be left out"),
            ("glisten specialize scenes/*.toml --suggest", "which uniforms are worth fixing"),
        ],
    ),
    (
        "stability",
        &[
            ("glisten stability scene.toml", "where f32 arithmetic harms the picture, and why"),
            ("glisten stability scene.toml --sweep material.shininess=1..10000:32", "with 32 values of a uniform"),
            ("glisten stability scene.toml --stiff --worst worst.toml", "with the worst inputs that can be found"),
            ("glisten stability scenes/ --format github", "in CI: annotations on the lines of all scenes"),
        ],
    ),
    (
        "trace",
        &[
            ("glisten trace scene.toml --pixel 120,80", "what each fragment of the pixel computed, line by line"),
            ("glisten trace scene.toml --vertex 3 --format json", "a vertex, for scripts"),
        ],
    ),
    (
        "report",
        &[
            ("glisten report scene.toml -o out", "error against work and run time, as a page and a table"),
            ("glisten report scene.toml -o out --ways auto", "with variants that are found automatically"),
            ("glisten report scene.toml -o out --compare old.json", "in CI: what got worse"),
            ("glisten report scene.toml -o out --budget rmse=1e-3", "the cheapest variant that is close enough"),
        ],
    ),
    ("gallery", &[("glisten gallery -o out", "a page with the pictures of the library's scenes")]),
    ("test", &[("glisten test tests/", "all .shader_test files of a folder")]),
    (
        "lib",
        &[
            ("glisten lib list", "the modules of the library"),
            ("glisten lib show phong", "what a module computes"),
            ("glisten lib export shaders/glisten", "the texts of all modules"),
            ("glisten lib export --wgsl src/shaders", "the modules as WGSL, for shaders that are written in it"),
            ("glisten lib export --rust -D GLISTEN_LIGHTS=16 src", "the structs of the uniforms, with 16 lights"),
            ("glisten lib prefilter room.hdr -o maps", "the light of a panorama, for the module `environment`"),
        ],
    ),
    (
        "new-scene",
        &[("glisten new-scene a.vert a.frag -o scene.toml", "a scene with everything that the program reads")],
    ),
    (
        "upgrade",
        &[
            ("glisten upgrade old.frag", "the text as GLSL 1.50 core"),
            ("glisten upgrade a.vert a.frag --to 330 -o new", "a program as GLSL 3.30"),
            ("glisten upgrade a.vert a.frag --in-place --scene a.toml", "if the picture of a scene stays the same"),
        ],
    ),
    (
        "port",
        &[
            ("glisten port pack --for minecraft-26.2 -o ported", "a resource pack for Minecraft's Vulkan"),
            (
                "glisten port shaders --for wgpu -o ported --prove",
                "an engine's shaders for wgpu, with their pictures compared",
            ),
            ("glisten port pack --for minecraft-26.2 --check", "exit 1 if something is left to port"),
        ],
    ),
    (
        "fixed-function",
        &[
            ("glisten fixed-function --lights 2 --fog exp --unit modulate", "both stages, with their switches"),
            ("glisten fixed-function scene.toml", "the stages that the draws of a scene do not name"),
        ],
    ),
    (
        "completions",
        &[
            ("glisten completions bash > ~/.local/share/bash-completion/completions/glisten", ""),
            ("glisten completions zsh > ~/.zfunc/_glisten", ""),
            ("glisten completions fish > ~/.config/fish/completions/glisten.fish", ""),
        ],
    ),
    ("man", &[("glisten man -o ~/.local/share/man/man1", "then: man glisten-lint")]),
];

/// The command line with the examples of each command after its help.
pub(super) fn with_examples(program: Command) -> Command {
    EXAMPLES.iter().fold(program, with)
}

/// The command line, with the examples of those commands that the arguments name.
pub(super) fn with_examples_of(program: Command, arguments: &[OsString]) -> Command {
    let named = EXAMPLES.iter().filter(|(name, _)| arguments.iter().any(|argument| argument == name));
    named.fold(program, with)
}

fn with(program: Command, (name, examples): &(&'static str, &[(&str, &str)])) -> Command {
    program.mut_subcommand(*name, |command| command.after_help(text(examples)))
}

fn text(examples: &[(&str, &str)]) -> String {
    let mut text = String::from("Examples:");
    for (line, meaning) in examples {
        text.push_str(&format!("\n  {line}"));
        if !meaning.is_empty() {
            text.push_str(&format!("\n      {meaning}"));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{EXAMPLES, with_examples};
    use crate::cli::Cli;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_examples_that_are_well_formed() {
        let program = with_examples(Cli::command());
        for command in program.get_subcommands() {
            let listed = EXAMPLES.iter().find(|(name, _)| *name == command.get_name());
            assert!(listed.is_some_and(|(_, examples)| !examples.is_empty()), "{}", command.get_name());
        }
        for (line, _) in EXAMPLES.iter().flat_map(|(_, examples)| *examples) {
            let words = line.split(" > ").next().unwrap_or(line).split(' ');
            let parsed = with_examples(Cli::command()).try_get_matches_from(words);
            assert!(parsed.is_ok(), "{line}: {:?}", parsed.err().map(|error| error.to_string()));
        }
    }
}

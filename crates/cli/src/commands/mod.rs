//! The commands, one file or folder each, and their table.
//!
//! *In:* the arguments of a command. *Out:* its [`Outcome`]. *Holds:* a command is a file with `run` and `EXAMPLES`, and a row here. The
//! row tells whether it hands code to a driver: `never`, `always`, or `asked` (then its arguments tell). Its arguments have its
//! sentence, too, for the command's own help: docs/commands.md, which a command checks, has both.

pub(crate) mod cache;
pub(crate) mod compile;
pub(crate) mod completions;
pub(crate) mod cost;
pub(crate) mod examples;
pub(crate) mod explain;
pub(crate) mod fixed_function;
pub(crate) mod fmt;
pub(crate) mod gallery;
pub(crate) mod library;
pub(crate) mod lint;
#[cfg(feature = "lsp")]
pub(crate) mod lsp;
pub(crate) mod man;
pub(crate) mod new_scene;
pub(crate) mod permutations;
#[cfg(feature = "play")]
pub(crate) mod play;
pub(crate) mod port;
pub(crate) mod reflect;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod rules;
pub(crate) mod snapshots;
pub(crate) mod specialize;
pub(crate) mod stability;
pub(crate) mod test;
pub(crate) mod trace;
pub(crate) mod upgrade;
pub(crate) mod verify;
pub(crate) mod versions;
pub(crate) mod watch;

use crate::console::Console;
use crate::exit::Outcome;
use clap::Subcommand;

/// Declares the commands.
macro_rules! commands {
    (@draws never $arguments:ident) => {{
        let _ = $arguments;
        false
    }};
    (@draws always $arguments:ident) => {{
        let _ = $arguments;
        true
    }};
    (@draws asked $arguments:ident) => {
        $arguments.draws_by_a_driver()
    };
    ($(
        $(#[doc = $doc:literal])*
        $(#[cfg(feature = $feature:literal)])?
        $name:ident($module:ident::$arguments:ident) draws $draws:ident;
    )*) => {
        /// The commands. Only the arguments of the one that is asked for are set up.
        #[derive(Debug, Subcommand)]
        #[command(defer = true)]
        pub(crate) enum Command {
            $(
                $(#[doc = $doc])*
                $(#[cfg(feature = $feature)])?
                $name($module::$arguments),
            )*
        }

        impl Command {
            /// Whether the command hands code to a driver.
            pub(crate) fn draws_by_a_driver(&self) -> bool {
                match self {
                    $(
                        $(#[cfg(feature = $feature)])?
                        Self::$name(arguments) => commands!(@draws $draws arguments),
                    )*
                }
            }

            /// Runs the command.
            pub(crate) fn run(&self, console: &Console) -> Outcome {
                match self {
                    $(
                        $(#[cfg(feature = $feature)])?
                        Self::$name(arguments) => $module::run(arguments, console),
                    )*
                }
            }
        }

        /// The examples of each command, in their order.
        pub(crate) const EXAMPLES: &[examples::Examples] = &[
            $(
                $(#[cfg(feature = $feature)])?
                $module::EXAMPLES,
            )*
        ];
    };
}

// A server outlives its workers, which draw: `play` itself does not.
commands! {
    /// Check shaders and the programs that they form
    Lint(lint::LintArgs) draws never;
    /// Translate programs to WGSL, SPIR-V and other targets, and write their reflection
    Compile(compile::CompileArgs) draws never;
    /// Show what a host needs to know: attributes, varyings, outputs, blocks, uniforms, samplers
    Reflect(reflect::ReflectArgs) draws never;
    /// Count the operations of shaders by line and class, on the shortest and the longest path
    Cost(cost::CostArgs) draws asked;
    /// Show what a diagnostic means, with a bad and a good example
    Explain(explain::ExplainArgs) draws never;
    /// List the lint rules: group, level, fixes
    Rules(rules::RulesArgs) draws never;
    /// List the versions and extensions of GLSL, and what an extension brings
    Versions(versions::VersionsArgs) draws never;
    /// Draw a scene
    Render(render::RenderArgs) draws asked;
    /// Draw a scene, or all scenes of a folder, on the GPU and the CPU, and compare the pictures
    Verify(verify::VerifyArgs) draws always;
    /// Leave out of the programs of scenes what their pictures do not need
    Specialize(specialize::SpecializeArgs) draws never;
    /// Find out where f32 arithmetic harms the picture of a scene, and why
    Stability(stability::StabilityArgs) draws never;
    /// Tell what each fragment of a pixel, or a vertex, computed: every expression with its value
    Trace(trace::TraceArgs) draws never;
    /// Measure variants of a scene's shading: error against work and run time
    ///
    /// Drawing takes seconds, timing up to half a minute more: `--seconds` sets the limit. Ctrl-C ends it early, with a report on what had
    /// finished.
    Report(report::ReportArgs) draws always;
    /// Draw every scene of the library onto a page
    Gallery(gallery::GalleryArgs) draws asked;
    /// Run .shader_test files, and the functions of shaders under a comment `//! test`
    Test(test::TestArgs) draws asked;
    /// Use the library of lighting models
    Lib(library::LibArgs) draws asked;
    /// Write a scene for a program, which draws at once
    NewScene(new_scene::NewSceneArgs) draws never;
    /// Format shaders and includes
    Fmt(fmt::FmtArgs) draws never;
    /// Serve an editor: the language server protocol over standard input and output
    #[cfg(feature = "lsp")]
    Lsp(lsp::LspArgs) draws never;
    /// Show scenes in a browser, and draw them again while they change
    #[cfg(feature = "play")]
    Play(play::PlayArgs) draws never;
    /// Rewrite old shaders (GLSL 1.10 to 1.40, compatibility, ES 1.00) as 1.50 core, 3.30, 4.50, 4.60, ES 3.00 or for Vulkan
    Upgrade(upgrade::UpgradeArgs) draws never;
    /// Port a folder of shaders to another host: Minecraft on Vulkan, Vulkan, wgpu, Bevy, WebGL 2
    Port(port::PortArgs) draws asked;
    /// Write the vertex and the fragment stage of OpenGL's fixed-function pipeline as GLSL
    FixedFunction(fixed_function::FixedFunctionArgs) draws never;
    /// Write a completion script for a shell to standard output
    Completions(completions::CompletionsArgs) draws never;
    /// Run a command again whenever its files change
    Watch(watch::WatchArgs) draws never;
    /// See what the cache of `compile` and `lint` holds, or clean it
    Cache(cache::CacheCommandArgs) draws never;
    /// Review pending snapshots of tests
    Snapshots(snapshots::SnapshotsArgs) draws never;
    /// Write manual pages: glisten.1, and one for each command
    Man(man::ManArgs) draws never;
}

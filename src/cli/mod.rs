//! The command line, with one file for each subcommand. Only this module prints, reads the environment, or exits.
//!
//! *In:* arguments and files. *Out:* results on standard output and in files; diagnostics on standard error (for
//! `lint` on standard output); an exit code: 0 nothing wrong found, 1 an input has errors or a check did not hold, 2
//! wrong usage or a file that cannot be read or written, 3 the machine lacks something. The highest one that applies
//! is returned.
//!
//! *Holds:* no panics, no half-written files, and the same bytes for the same input with any `-j`.

#[macro_use]
mod commands;

mod args;
mod baseline;
mod baselines;
mod batch;
mod bounds;
mod buffers;
mod cache;
mod cache_command;
mod child;
mod compile;
mod completions;
mod config;
mod configurations;
mod console;
mod cost;
mod cost_rank;
mod cost_table;
mod depfile;
mod digest;
mod engine;
mod examples;
mod exit;
mod explain;
mod files;
mod fix;
mod fixed_function;
mod fmt;
mod follow;
mod fullscreen;
mod gallery;
mod guard;
mod inputs;
mod interrupt;
mod journal;
mod library;
mod library_export;
mod library_prefilter;
mod lint;
mod lint_rules;
mod lone;
#[cfg(feature = "lsp")]
mod lsp;
#[cfg(feature = "lsp")]
mod lsp_channel;
#[cfg(feature = "lsp")]
mod lsp_drawing;
#[cfg(feature = "lsp")]
mod lsp_files;
#[cfg(feature = "lsp")]
mod lsp_judged;
#[cfg(feature = "lsp")]
mod lsp_project;
#[cfg(feature = "lsp")]
mod lsp_shown;
mod machine;
mod made;
mod man;
mod memo;
pub mod memory;
mod new_scene;
mod new_scene_model;
mod not_checked;
mod opengl;
mod optimize;
mod outputs;
mod permutations;
mod pictures;
#[cfg(feature = "play")]
mod play;
mod port;
mod profile;
mod progress;
mod recall;
mod reflect;
mod render;
mod report;
mod report_checks;
mod responses;
mod rules;
mod scene_ranges;
mod scenes;
mod search;
mod session;
mod settings;
mod sizes;
mod snapshots;
mod specialize;
mod stability;
mod stability_library;
mod stages;
mod strings;
mod suggest;
mod supervisor;
pub mod survey;
mod test;
mod texts;
mod timed;
mod trace;
mod unfinished;
mod upgrade;
mod variants;
mod varyings;
mod verify;
mod watch;
mod with;
mod witness;

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use console::{ColorChoice, Console};
use exit::{Exit, Failure, Outcome};
use glisten_scene::confine_to;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;
use supervisor::Supervised;

/// The stack size of the thread that runs a command.
const STACK_BYTES: usize = 16 << 20;

/// Check, translate, draw and measure GLSL: versions 1.10 to 4.60, and those of OpenGL ES
#[derive(Debug, Parser)]
#[command(name = "glisten", version, max_term_width = 100)]
#[command(after_help = "Exit codes: 0 nothing wrong found; 1 an input is wrong or a check did not hold;\n\
    2 wrong usage, or a file cannot be read or written; 3 the machine lacks something;\n\
    130 Ctrl-C stopped it.")]
struct Cli {
    #[command(flatten)]
    global: GlobalArgs,
    #[command(subcommand)]
    command: Command,
}

#[derive(Args, Debug)]
struct GlobalArgs {
    /// Omit progress and summaries
    #[arg(short, long, global = true)]
    quiet: bool,
    /// When to use colors
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: ColorChoice,
    /// Read only files in this folder, after links are followed: for sources and scenes from strangers
    #[arg(long, global = true, value_name = "DIR")]
    sandbox: Option<PathBuf>,
    /// End when more memory would be needed, such as 512M or 2G (Linux)
    #[arg(long, global = true, value_name = "SIZE", value_parser = sizes::parse)]
    max_memory: Option<u64>,
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
    Rules(lint_rules::RulesArgs) draws never;
    /// Draw a scene
    Render(render::RenderArgs) draws asked;
    /// Draw a scene, or all scenes of a folder, on the GPU and the CPU, and compare the pictures
    Verify(verify::VerifyArgs) draws always;
    /// Leave out of the programs of scenes what their pictures do not need
    Specialize(specialize::SpecializeArgs) draws never;
    /// Find out where f32 arithmetic harms the picture of a scene, and why
    Stability(stability::StabilityArgs) draws never;
    /// Tell what each fragment of a pixel, or a vertex, computed: every expression with its value
    Trace(follow::TraceArgs) draws never;
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
    /// Rewrite old shaders (GLSL 1.10 to 1.40, compatibility, ES 1.00) as 1.50 core, 3.30, 4.50, 4.60 or ES 3.00
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
    Cache(cache_command::CacheCommandArgs) draws never;
    /// Review pending snapshots of tests
    Snapshots(snapshots::SnapshotsArgs) draws never;
    /// Write manual pages: glisten.1, and one for each command
    Man(man::ManArgs) draws never;
}

/// Runs the program with these arguments, the first being its own name, in this process.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    match parsed(arguments) {
        Ok((command, console)) => carry_out(&command, console).into(),
        Err(exit) => exit.into(),
    }
}

/// Runs the program like [`run`]. What draws by a driver runs in a copy of this process, so that this one can tell what a driver
/// did that crashed. This process must not have another thread.
pub fn run_supervised(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let (command, console) = match parsed(arguments) {
        Ok(parsed) => parsed,
        Err(exit) => return exit.into(),
    };
    let resumes = matches!(command, Command::Test(_) | Command::Port(_));
    if command.draws_by_a_driver() {
        Supervised { resumes }.run(&console, &|| carry_out(&command, console)).into()
    } else {
        carry_out(&command, console).into()
    }
}

/// The command of the arguments, or the exit code of wrong ones and of those that ask for help.
fn parsed(arguments: impl IntoIterator<Item = OsString>) -> Result<(Command, Console), Exit> {
    let arguments = responses::expanded(arguments.into_iter().collect())
        .map_err(|failure| end(Err(failure), &Console::new(false, ColorChoice::Auto)))?;
    let parsed = examples::with_examples_of(Cli::command(), &arguments).try_get_matches_from(arguments);
    let cli = parsed.and_then(|matches| Cli::from_arg_matches(&matches)).map_err(|error| usage(&error))?;
    let console = Console::new(cli.global.quiet, cli.global.color);
    if let Some(folder) = &cli.global.sandbox {
        confine_to(folder).map_err(|error| {
            let message = format!("`{}` cannot be the sandbox: {error}", folder.display());
            end(Err(Failure::usage(message)), &console)
        })?;
    }
    if let Some(bytes) = cli.global.max_memory {
        memory::limit(bytes).map_err(|failure| end(Err(failure), &console))?;
    }
    Ok((cli.command, console))
}

/// Runs a command on a thread with a large stack, and reports a failure.
fn carry_out(command: &Command, console: Console) -> Exit {
    guard::silence_panics();
    let work = || guard::guarded(|| command.run(&console));
    let joined = std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work);
        thread.map(std::thread::ScopedJoinHandle::join)
    });
    let outcome = match joined {
        Ok(Ok(Ok(outcome))) => outcome,
        Ok(Ok(Err(panic))) => {
            let message = format!("internal error: {panic}");
            Err(Failure::new(Exit::Content, message)
                .help("this is a fault of glisten; please report it with the input"))
        }
        Ok(Err(_)) => Err(Failure::new(Exit::Content, "internal error")),
        Err(error) => Err(Failure::new(Exit::Machine, format!("the system gives no thread: {error}"))),
    };
    end(outcome, &console)
}

/// Reports wrong arguments, or prints the requested help or version.
fn usage(error: &clap::Error) -> Exit {
    // If it cannot be printed, there is no other place to report it.
    let _ = error.print();
    if error.use_stderr() { Exit::Usage } else { Exit::Ok }
}

fn end(outcome: Outcome, console: &Console) -> Exit {
    match outcome {
        Ok(exit) => exit,
        Err(Failure::OutputClosed) => Exit::Ok,
        Err(Failure::Told { exit, message, help }) => {
            console.failure(&message, help.as_deref());
            exit
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_well_formed() {
        Cli::command().debug_assert();
    }
}

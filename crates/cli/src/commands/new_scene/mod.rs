//! `glisten new-scene`: writes a scene for a program, with a line for everything that the program reads, that draws at once.
//!
//! *In:* the shaders of a program, a fragment shader alone, or one of the fixed-function pipeline's time. *Out:* TOML that loads without a
//! diagnostic and keeps what the command line says about the sources. The phases: what the program reads (`reads`), geometries and
//! cameras that may suit it (`forms`), what its numbers mean (`meanings`), their values (`values`, `textures`), the text
//! (`text`), and trials on the reference, which decide (`trial`).

mod choice;
mod forms;
mod meanings;
mod model;
mod reads;
mod text;
pub(crate) mod textures;
mod trial;
mod values;
mod varyings;

use crate::arguments::args::{BindingArgs, LevelArgs, SourceArgs};
use crate::arguments::stages::StageArg;
use crate::buffers;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::fullscreen;
use crate::inputs::{Group, Input, STDIN};
use crate::session::{Session, Unit};
use choice::{Choice, Taste};
use clap::Args;
use forms::{Shape, forms, shape_of};
use glisten_front::hir::{Global, Shader, Stage, Storage};
use glisten_front::link::{Output, Program};
use glisten_scene::picture::ImageFormat;
use glisten_scene::{default_tessellation, shape_names, toml_string};
use glisten_sources::engines::{Member, STYLES};
use glisten_sources::stages::extension;
use glisten_sources::{members, stages};
use glisten_verify::scene::is_model_file;
use reads::{Reads, scalar_of};
use std::fmt::Write;
use std::path::{Component, Path, PathBuf};
use std::time::Instant;
use text::Head;
use trial::{BUDGET, Chosen, Trials, choose};
use values::alternatives;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples =
    &[("glisten new-scene a.vert a.frag -o scene.toml", "a scene with everything that the program reads")];

/// The usual width and height of the window.
const SIDE: u32 = 256;

/// Write a scene for a program, which draws at once
#[derive(Args, Debug)]
pub(crate) struct NewSceneArgs {
    /// The shaders of the program, or `-` for standard input, which becomes a file next to the scene; a fragment shader alone gets a vertex shader for a triangle that covers the window, a vertex shader
    /// alone a fragment shader that shows its varyings, and either the fixed-function pipeline's where that fits; or a model (.obj, .gltf, .glb), which gets a camera and lights
    #[arg(num_args = 1..=3, required = true, value_names = ["A.vert", "B.frag"])]
    files: Vec<String>,
    /// The scene file to create (default: standard output)
    #[arg(short, long, value_name = "SCENE.toml")]
    output: Option<PathBuf>,
    /// Draw this mesh: a file, or a shape such as `torus`
    #[arg(long, value_name = "FILE|SHAPE")]
    mesh: Option<String>,
    /// The stage of standard input, and of a single file
    #[arg(long, value_enum)]
    stage: Option<StageArg>,
    /// The width and height of the window
    #[arg(long, value_name = "PIXELS", default_value_t = SIDE, value_parser = clap::value_parser!(u32).range(1..=4096))]
    size: u32,
    /// Whether findings are not told: another command has told them.
    #[arg(skip)]
    is_silent: bool,
    /// Whether a shader that is there already is taken in the place of the one that would be written.
    #[arg(skip)]
    keeps_shaders: bool,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

impl NewSceneArgs {
    /// The arguments for the files of a program, without a mesh.
    pub(crate) fn of(files: Vec<String>, output: PathBuf, size: u32, sources: &SourceArgs, levels: &LevelArgs) -> Self {
        let (sources, levels) = (sources.clone(), levels.clone());
        let output = Some(output);
        Self { files, output, mesh: None, stage: None, size, is_silent: true, keeps_shaders: false, sources, levels }
    }

    /// The arguments for a page that holds texts, with a window of the usual size.
    #[cfg(feature = "play")]
    pub(crate) fn of_page(files: Vec<String>, output: PathBuf, sources: &SourceArgs, levels: &LevelArgs) -> Self {
        Self { keeps_shaders: true, ..Self::of(files, output, SIDE, sources, levels) }
    }
}

/// A scene that was made, and is not written yet.
pub(crate) struct Made {
    /// Its text.
    pub(crate) scene: String,
    /// The shader that was written for it, if one was missing.
    pub(crate) shader: Option<Missing>,
    exit: Exit,
}

/// A shader that a program lacked. Its text is that of the file in this process ([`buffers`]).
#[derive(Clone, Debug)]
pub(crate) struct Missing {
    /// The file.
    pub(crate) path: PathBuf,
    /// Its text.
    pub(crate) text: String,
}

/// Runs the command.
pub(crate) fn run(args: &NewSceneArgs, console: &Console) -> Outcome {
    if let Some(output) = args.output.as_deref().filter(|output| output.exists()) {
        let failure = Failure::usage(format!("`{}` exists already", output.display()));
        return Err(failure.help("name a new file, or remove the old one"));
    }
    if let Some(output) = args.output.as_deref().filter(|output| ImageFormat::of_name(output).is_some()) {
        let failure = Failure::usage(format!("`{}` is the name of a picture", output.display()));
        return Err(failure.help("name the scene, `-o SCENE.toml`; `glisten render` draws it"));
    }
    let folder = args.output.as_deref().and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        // A scene is tried where it will be.
        let failure = Failure::usage(format!("there is no folder `{}`", folder.display()));
        return Err(failure.help("make it first: the files of the scene are found from there"));
    }
    if let [model] = args.files.as_slice()
        && is_model_file(model)
    {
        let folder = args.output.as_deref().map(|output| output.parent().unwrap_or(Path::new("")));
        return model::run(model, &relative(model, folder), args.output.as_deref(), console);
    }
    let Made { scene, shader, exit } = match make(args, console)? {
        Ok(made) => made,
        Err(exit) => return Ok(exit),
    };
    if let Some(Missing { path, text }) = shader {
        files::write(&path, text.as_bytes())?;
        console.remark(&format!("wrote {}", path.display()));
    }
    match &args.output {
        Some(output) => {
            files::write(output, scene.as_bytes())?;
            let path = output.display();
            // A PNG holds no numbers of an integer framebuffer.
            let picture = output.with_extension(if scene.contains("\nformat = ") { "npy" } else { "png" });
            console.remark(&format!("wrote {path}; draw it: glisten render {path} -o {}", picture.display()));
        }
        None => console.output(&scene)?,
    }
    Ok(exit)
}

/// Makes a scene for a program, and writes nothing. The inner `Err` is the exit code of sources with errors.
///
/// # Errors
/// The program is not complete, or a file cannot be read.
pub(crate) fn make(args: &NewSceneArgs, console: &Console) -> Result<Result<Made, Exit>, Failure> {
    args.mesh.as_deref().map_or(Ok(()), check_mesh)?;
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 0)?;
    let files = named_files(args)?;
    let (inputs, shader) = match stages_of(args, &files, &mut session)? {
        Ok(found) => found,
        Err(exit) => return Ok(Err(exit)),
    };
    let folder = args.output.as_deref().map(|output| output.parent().unwrap_or(Path::new("")));
    let stages = inputs.iter().map(|input| (input.stage, relative(&input.name, folder))).collect();
    let name = inputs.first().map(Input::stem).unwrap_or_default();
    let units = session.compile(vec![Group::new(name, inputs)]);
    let exit = if args.is_silent { Exit::Ok } else { session.tell_units(&units, false)? };
    let Some((unit, program)) = units.first().and_then(|unit| Some((unit, unit.sound_program()?))) else {
        return Ok(Err(exit.max(Exit::Content)));
    };
    refuse_mixed(program)?;
    let head = Head { stages, sources: source_lines(&args.sources, folder) };
    let scene = written(args, &session, (unit, program), &head, folder, console);
    Ok(Ok(Made { scene, shader, exit }))
}

/// The pictures of a scene have one format, which holds either fractions or integers of one kind.
fn refuse_mixed(program: &Program) -> Result<(), Failure> {
    let kind = |output: &Output| scalar_of(&program.types, output.ty);
    let outputs = &program.interface.outputs;
    let Some((first, other)) =
        outputs.first().and_then(|first| Some((first, outputs.iter().find(|output| kind(output) != kind(first))?)))
    else {
        return Ok(());
    };
    let shown = |output: &Output| format!("`{}` ({})", output.name, program.types.name(output.ty));
    let message = format!(
        "no scene draws this program: the pictures of a scene have one format, and {} and {} need two",
        shown(first),
        shown(other)
    );
    Err(Failure::new(Exit::Content, message)
        .help("write the integers as floats, or draw them with a program of their own"))
}

/// A scene that names the shaders of a program and nothing else: what a page shows until their errors are mended.
#[cfg(feature = "play")]
pub(crate) fn draft(args: &NewSceneArgs) -> String {
    let folder = args.output.as_deref().map(|output| output.parent().unwrap_or(Path::new("")));
    let mut text = "# A draft: the shaders have errors.\n[[draw]]\n".to_owned();
    for file in &args.files {
        let stage = stages::by_name(Path::new(file)).unwrap_or(Stage::Fragment);
        let _ = writeln!(text, "{} = {}", stage.name(), toml_string(&relative(file, folder)));
    }
    text + &source_lines(&args.sources, folder) + "vertex_count = 3\n"
}

/// The shaders by their names. A scene names files, so standard input becomes one.
fn named_files(args: &NewSceneArgs) -> Result<Vec<String>, Failure> {
    let is_input = |file: &&String| *file == STDIN;
    match args.files.iter().filter(is_input).count() {
        0 => return Ok(args.files.clone()),
        1 => {}
        _ => return Err(Failure::usage("standard input is one shader, and is named more than once")),
    }
    let Some(stage) = args.stage else {
        let failure = Failure::usage("cannot tell the shader stage of standard input");
        return Err(failure.help("add `--stage vertex` or another"));
    };
    let Some(output) = &args.output else {
        let failure = Failure::usage("a scene names files, and standard input becomes one next to it");
        return Err(failure.help("add `-o SCENE.toml`"));
    };
    let path = output.with_extension(extension(stage.into()));
    if path.exists() {
        let failure = Failure::usage(format!("`{}` exists already", path.display()));
        return Err(failure.help("name it in the place of `-`, or remove it"));
    }
    let text = files::read_source("standard input", None).map_err(|error| {
        let failure = Failure::new(Exit::Content, error.message);
        if let Some(help) = error.help { failure.help(help) } else { failure }
    })?;
    files::write(&path, text.as_bytes())?;
    let name = path.to_string_lossy().into_owned();
    Ok(args.files.iter().map(|file| if is_input(&file) { name.clone() } else { file.clone() }).collect())
}

/// Refuses a mesh that is not there.
fn check_mesh(word: &str) -> Result<(), Failure> {
    match shape_of(word) {
        Shape::File(file) if !Path::new(&file).is_file() => Err(Failure::usage(format!("there is no file `{file}`"))
            .help("`--mesh` takes a mesh in OBJ or glTF, or a shape")),
        Shape::Named(shape, _) if default_tessellation(&shape).is_none() => {
            let shapes: Vec<&str> = shape_names().collect();
            let failure = Failure::usage(format!("there is no shape `{shape}`"));
            Err(failure.help(format!("shapes are {}; a file has a dot in its name", shapes.join(", "))))
        }
        _ => Ok(()),
    }
}

/// The text of the scene that shows most.
fn written(
    args: &NewSceneArgs,
    session: &Session<'_>,
    (unit, program): (&Unit, &Program),
    head: &Head,
    folder: Option<&Path>,
    console: &Console,
) -> String {
    let reads = Reads::new(program, &unit.batch.sources);
    let mesh = args.mesh.as_deref().map(|word| match shape_of(word) {
        Shape::File(file) => Shape::File(relative(&file, folder)),
        shape => shape,
    });
    let is_flat_engine =
        args.sources.engine.as_deref().is_some_and(|engine| ["libretro", "minecraft", "isf"].contains(&engine));
    let forms = forms(&reads, mesh, is_flat_engine);
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from("scene.toml"));
    let text = |choice: &Choice| text::scene(&reads, head, choice);
    let has_colors = reads.dependence.color || reads.dependence.alpha;
    let trials = Trials {
        path: &path.to_string_lossy(),
        compiler: session.compiler(),
        text: &text,
        has_colors,
        deadline: Instant::now() + BUDGET,
        alternatives: &alternatives(&reads),
    };
    let Some(Chosen { choice, shown }) = choose(&trials, &forms, args.size) else {
        let form = forms::Form::Count("triangles", 3);
        return text(&Choice { form, taste: Taste::default(), side: args.size, changed: None });
    };
    let words = choice.form.words();
    console.remark(&match shown {
        Some(shown) if shown.covered == 0.0 => {
            "no geometry that was tried covers a pixel: fill in what the program needs".to_owned()
        }
        Some(shown) => {
            let flat = match (shown.is_flat(), has_colors, reads.dependence.written) {
                (false, ..) => "",
                (true, true, _) => ", in one color",
                (true, false, true) => {
                    ", in one color: that of the program depends on no varying and not on `gl_FragCoord`"
                }
                (true, false, false) => ", in one color: the program writes none",
            };
            format!("drew {words}: it covers {:.0} % of the window{flat}", shown.covered * 100.0)
        }
        None => {
            format!("chose {words}, which was not drawn: the program takes long, or the reference does not draw it")
        }
    });
    text(&choice)
}

/// The stages of a program, and the shader that it lacked.
type Stages = (Vec<Input>, Option<Missing>);

/// The stages of the program; a fragment shader that needs a vertex shader gets one. The inner `Err` is the exit code of sources with errors.
fn stages_of(
    args: &NewSceneArgs,
    files: &[String],
    session: &mut Session<'_>,
) -> Result<Result<Stages, Exit>, Failure> {
    let input = |name: &str, stage| Input { name: name.to_owned(), path: Some(PathBuf::from(name)), stage, part: None };
    if let [both] = files {
        if args.stage.is_none() && contains_both(both) {
            return Ok(Ok((vec![input(both, Stage::Vertex), input(both, Stage::Fragment)], None)));
        }
        let told = args.stage.map(Stage::from).or_else(|| stages::by_name(Path::new(both)));
        let stage = told.unwrap_or(Stage::Fragment);
        return alone(args, input(both, stage), session);
    }
    let order = match files.len() {
        2 => &[Stage::Vertex, Stage::Fragment][..],
        _ => &[Stage::Vertex, Stage::Geometry, Stage::Fragment],
    };
    let told = files.iter().map(|file| stages::by_name(Path::new(file)));
    let told: Vec<Option<Stage>> = told.collect();
    let stage = |index: usize| told.get(index).copied().flatten().or(order.get(index).copied());
    let mut inputs: Vec<Input> =
        files.iter().enumerate().filter_map(|(index, file)| Some(input(file, stage(index)?))).collect();
    inputs.sort_by_key(|input| order.iter().position(|stage| *stage == input.stage));
    if inputs.windows(2).any(|pair| matches!(pair, [a, b] if a.stage == b.stage)) {
        let failure = Failure::usage("two of the files are of one stage");
        return Err(failure.help("name a vertex and a fragment shader, and a geometry shader if there is one"));
    }
    Ok(Ok((inputs, None)))
}

/// Whether a file contains the vertex and the fragment shader.
fn contains_both(file: &str) -> bool {
    let path = Path::new(file);
    let text = files::read_source(file, Some(path)).ok();
    let members = text.map(|text| members(Some(path), &text)).unwrap_or_default();
    let has = |member: &Member, stage| member.part(stage).is_some();
    members.first().is_some_and(|member| has(member, Stage::Vertex) && has(member, Stage::Fragment))
}

/// The stages for a shader that comes alone: with the fixed-function pipeline's other one, or with one that is made.
fn alone(args: &NewSceneArgs, input: Input, session: &mut Session<'_>) -> Result<Result<Stages, Exit>, Failure> {
    let units = session.compile(vec![Group::new(input.stem(), vec![input.clone()])]);
    let Some(program) = units.first().and_then(Unit::sound_program) else {
        let exit = if args.is_silent { Exit::Ok } else { session.tell_units(&units, false)? };
        return Ok(Err(exit.max(Exit::Content)));
    };
    let Some(shader) = program.stages.first() else { return Ok(Err(Exit::Content)) };
    if suits_pipeline(shader) {
        return Ok(Ok((vec![input], None)));
    }
    let (stage, ending) = match input.stage {
        Stage::Fragment => (Stage::Vertex, "fullscreen.vert"),
        Stage::Vertex => (Stage::Fragment, "varyings.frag"),
        Stage::Geometry => {
            let failure = Failure::usage(format!("`{}` is a geometry shader alone", input.name));
            return Err(failure.help("name all shaders of the program"));
        }
    };
    let (own, other) = (input.stage.name(), stage.name());
    let Some(output) = &args.output else {
        let message = format!("a {own} shader alone needs a {other} shader, which is written next to the scene");
        return Err(Failure::usage(message).help(format!("add `-o SCENE.toml`, or name the {other} shader, too")));
    };
    let path = output.with_file_name(format!("{}_{ending}", input.stem()));
    let exists = path.exists();
    if exists && !args.keeps_shaders {
        let failure = Failure::usage(format!("`{}` exists already", path.display()));
        return Err(failure.help(format!("name it with the {own} shader")));
    }
    let text = match stage {
        Stage::Vertex => fullscreen::vertex_shader(&program.types, shader)?,
        _ => varyings::fragment_shader(&program.types, shader),
    };
    let missing = (!exists).then(|| Missing { path: path.clone(), text });
    if let Some(Missing { path, text }) = &missing {
        buffers::put(path, text.clone().into_bytes());
    }
    let name = path.to_string_lossy().into_owned();
    let made = Input { name, path: Some(path), stage, part: None };
    Ok(Ok((if stage == Stage::Vertex { vec![made, input] } else { vec![input, made] }, missing)))
}

/// Whether the fixed-function pipeline completes a shader: a vertex shader of its time, or a fragment shader that reads nothing but the
/// pipeline's varyings.
fn suits_pipeline(shader: &Shader) -> bool {
    let read = |global: &&Global| global.storage == Storage::In && global.builtin.is_none() && global.used;
    let mut inputs = shader.globals.iter().filter(read).peekable();
    glisten_scene::fixed::has_fixed_function(shader)
        && (shader.stage == Stage::Vertex || (inputs.peek().is_some() && inputs.all(Global::is_fixed)))
}

/// The lines of a draw for what the command line says about sources.
fn source_lines(args: &SourceArgs, folder: Option<&Path>) -> String {
    let mut lines = String::new();
    let paths = |paths: &[PathBuf]| {
        let names = paths.iter().map(|path| toml_string(&relative(&path.to_string_lossy(), folder)));
        names.collect::<Vec<_>>().join(", ")
    };
    let style = args.include_style.and_then(|style| STYLES.iter().find(|row| row.style == style));
    let texts = [
        ("engine", args.engine.as_deref()),
        ("assume_version", args.assume_version.as_deref()),
        ("include_style", style.map(|row| row.name)),
    ];
    for (key, value) in texts {
        if let Some(value) = value {
            let _ = writeln!(lines, "{key} = {}", toml_string(value));
        }
    }
    for (key, list) in [("includes", &args.include_dirs), ("preludes", &args.preludes)] {
        if !list.is_empty() {
            let _ = writeln!(lines, "{key} = [{}]", paths(list));
        }
    }
    if !args.defines.is_empty() {
        let defines = args.defines.iter().map(|(name, value)| format!("{name} = {}", toml_string(value)));
        let _ = writeln!(lines, "defines = {{ {} }}", defines.collect::<Vec<_>>().join(", "));
    }
    lines
}

/// The name of a file as a scene in `folder` gives it: relative, unless the two have no folder in common but the root.
fn relative(file: &str, folder: Option<&Path>) -> String {
    let Some(folder) = folder else { return file.to_owned() };
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = absolute(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let file = absolute(Path::new(file));
    let top = |path: &Path| {
        path.components().find(|part| matches!(part, Component::Normal(_))).map(|part| part.as_os_str().to_owned())
    };
    let is_near = top(&folder) == top(&file) && top(&file).is_some();
    let path = files::from_folder(&file, &folder).filter(|_| is_near).unwrap_or(file);
    path.to_string_lossy().into_owned()
}

//! Which files a command works on, and which of them form one program.
//!
//! *In:* names on the command line. *Out:* [`Group`]s in the order of their first names: files with the same folder
//! and stem and different stages, and each `--program`.
//!
//! *Holds:* a file that is named twice counts once; a file in a `--program` forms no group of its own.

use crate::arguments::args::{ProgramArgs, SourceArgs};
use crate::arguments::engine::{Engines, STDIN as SHOWN_STDIN};
use crate::console::Console;
use crate::exit::Failure;
use crate::files;
use crate::search::{self, Left, Why};
use glisten_front::hir::Stage;
use glisten_sources::embedded::{self, Filling, Host};
use glisten_sources::engines::combined;
use glisten_sources::{members, stages};
use ignore::WalkBuilder;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of standard input on the command line.
pub(crate) const STDIN: &str = "-";

/// A shader to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Input {
    /// The name that diagnostics show.
    pub(crate) name: String,
    /// The file; `None` for standard input.
    pub(crate) path: Option<PathBuf>,
    /// The stage.
    pub(crate) stage: Stage,
    /// The program of the file, if it contains several stages.
    pub(crate) part: Option<PartOf>,
}

/// A program of a file that contains several stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PartOf {
    /// Its index.
    index: usize,
    /// Its name, if the file has several programs.
    name: Option<String>,
    /// The language of the file, if the program is in its strings, and what stands for interpolations.
    string: Option<(Host, Filling)>,
}

impl PartOf {
    /// A program in the strings of a file.
    pub(crate) fn in_string(index: usize, name: String, host: Host) -> Self {
        Self { index, name: Some(name), string: Some((host, Filling::default())) }
    }

    /// The language of the file, and the index of the program among those in its strings.
    pub(crate) fn host(&self) -> Option<(usize, Host)> {
        self.string.map(|(host, _)| (self.index, host))
    }

    /// Changes what stands for interpolations.
    pub(crate) fn fill(&mut self, filling: Filling) {
        self.string = self.string.map(|(host, _)| (host, filling));
    }

    /// The macros that select a stage in a file, and those that select the others.
    pub(crate) fn macros(&self, file: &str, stage: Stage) -> (Vec<String>, Vec<String>) {
        if self.string.is_some() {
            return Default::default();
        }
        let members = combined::members(file);
        let parts = members.get(self.index).map(|member| member.parts.as_slice()).unwrap_or_default();
        let of = |is_own: bool| {
            let parts = parts.iter().filter(move |part| (part.stage == stage) == is_own);
            parts.flat_map(|part| &part.defines).map(|(name, _)| name.clone()).collect::<Vec<_>>()
        };
        let (set, others) = (of(true), of(false));
        let unset = others.into_iter().filter(|name| !set.contains(name)).collect();
        (set, unset)
    }

    /// The text of a stage, where the file has several programs; otherwise the whole text, which is taken apart later.
    pub(crate) fn text(&self, text: &Arc<str>, stage: Stage) -> Arc<str> {
        if let Some((host, filling)) = self.string {
            let program = embedded::programs(host, text).into_iter().nth(self.index);
            let own = program.and_then(|program| Some(program.shader(stage)?.text(text, filling)));
            return own.unwrap_or_else(|| Arc::clone(text));
        }
        let members = self.name.as_ref().map(|_| combined::members(text)).unwrap_or_default();
        let part = members.get(self.index).and_then(|member| member.part(stage));
        part.map_or_else(|| Arc::clone(text), |part| part.text(text))
    }
}

impl Input {
    /// The name for its outputs: `phong.vert`; for standard input, `stdin.vert`.
    pub(crate) fn file_name(&self) -> String {
        match &self.path {
            Some(_) if self.part.is_some() => format!("{}.{}", self.stem(), stages::extension(self.stage)),
            Some(path) => path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            None => format!("stdin.{}", stages::extension(self.stage)),
        }
    }

    /// Whether it is of a program after the first of its file.
    fn is_later(&self) -> bool {
        self.part.as_ref().is_some_and(|part| part.index > 0)
    }

    /// The name without the part that says the stage.
    pub(crate) fn stem(&self) -> String {
        let named = self.part.as_ref().and_then(|part| part.name.clone());
        named.or(self.path.as_deref().map(stages::stem)).unwrap_or("stdin".to_owned())
    }
}

/// How to say the stage of files whose names do not tell it.
pub(crate) const SAY_STAGE: &str =
    "say it by `stage = \"fragment\"` in a `[[source]]` table of glisten.toml, or name a file, with `--stage fragment`";

/// Files that form one program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    /// The stem of the first file.
    pub(crate) name: String,
    /// The inputs, at least one.
    pub(crate) inputs: Vec<Input>,
    /// Whether the names of files alone say that they form a program: the host may give it more shaders of a stage.
    pub(crate) is_guess: bool,
}

impl Group {
    /// A program that somebody named as one.
    pub(crate) fn new(name: impl Into<String>, inputs: Vec<Input>) -> Self {
        Self { name: name.into(), inputs, is_guess: false }
    }

    /// Whether its stages are in several files.
    pub(crate) fn has_files(&self) -> bool {
        self.inputs.iter().any(|input| self.inputs.first().is_some_and(|first| first.path != input.path))
    }

    /// Whether it has only one stage, which will need a partner.
    pub(crate) fn is_lone(&self) -> bool {
        self.inputs.iter().all(|input| Some(input.stage) == self.inputs.first().map(|first| first.stage))
    }
}

/// The inputs that the command line names.
#[derive(Debug, Default)]
pub(crate) struct Inputs {
    /// The programs: those that names of files form, then each `--program`.
    pub(crate) groups: Vec<Group>,
    /// The number of the former.
    n_by_names: usize,
    /// Folders that contain no shader.
    pub(crate) empty_folders: Vec<String>,
    /// The files of `--program`s of one stage.
    lone_programs: Vec<String>,
    /// The files that a search found and the command line does not name.
    pub(crate) found: BTreeSet<PathBuf>,
    /// The files that a search saw and did not take.
    pub(crate) left: Vec<Left>,
    /// The folders of files that a search found, below the folder that was searched.
    below: BTreeMap<PathBuf, PathBuf>,
}

impl Inputs {
    /// Whether a folder was searched.
    pub(crate) fn has_search(&self) -> bool {
        !self.found.is_empty() || !self.left.is_empty() || !self.empty_folders.is_empty()
    }

    /// Marks the programs of which a search found a file.
    pub(crate) fn mark_guesses(&mut self) {
        for group in self.groups.iter_mut().take(self.n_by_names) {
            let mut paths = group.inputs.iter().filter_map(|input| input.path.as_ref());
            group.is_guess = group.has_files() && paths.any(|path| self.found.contains(path));
        }
    }

    /// Tells which of the folders have no shader.
    pub(crate) fn tell_empty_folders(&self, console: &Console) {
        for folder in &self.empty_folders {
            console.remark(&format!("no shader was found in `{folder}`"));
        }
    }

    /// Tells how many files with a `main` a search left because nothing tells their stages.
    pub(crate) fn tell_without_stage(&self, console: &Console) {
        let count = self.left.iter().filter(|left| left.why == Why::NoStage).count();
        let files = match count {
            0 => return,
            1 => "1 file was not taken: it has a `main`, and its name does not tell its stage".to_owned(),
            _ => format!("{count} files were not taken: they have a `main`, and their names do not tell their stages"),
        };
        console.remark(&format!("{files}; {SAY_STAGE}"));
    }

    /// Tells which `--program`s link nothing.
    pub(crate) fn tell_lone_programs(&self, console: &Console) {
        for name in &self.lone_programs {
            console.remark(&format!(
                "`--program {name}` is one file, and nothing is linked: write `--program a.vert,b.frag`"
            ));
        }
    }

    /// The folder of a program's outputs below that of all outputs: outputs of a searched folder lie as its files do.
    pub(crate) fn below(&self) -> impl Fn(&Group) -> PathBuf + Sync + use<> {
        let below = self.below.clone();
        move |group| {
            let first = group.inputs.first().and_then(|input| input.path.as_ref());
            first.and_then(|path| below.get(path)).cloned().unwrap_or_default()
        }
    }
}

/// The files of the command line, or the current folder if it names nothing.
pub(crate) fn named_or_here(files: &[PathBuf], args: &ProgramArgs) -> Vec<PathBuf> {
    if files.is_empty() && args.programs.is_empty() { vec![PathBuf::from(".")] } else { files.to_vec() }
}

/// The scene files that the command line names: files as they are, folders searched for `.toml` files that draw.
///
/// # Errors
/// A folder that cannot be read, or that contains no scene.
pub(crate) fn scene_files(names: &[String]) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    for name in names {
        let path = Path::new(name);
        if !path.is_dir() {
            files.push(name.clone());
            continue;
        }
        let mut found: Vec<String> = WalkBuilder::new(path)
            .build()
            .filter_map(Result::ok)
            .filter(|entry| entry.path().extension().is_some_and(|extension| extension == "toml"))
            .filter(|entry| entry.path().is_file())
            .filter(|entry| fs::read_to_string(entry.path()).is_ok_and(|text| text.contains("[[draw]]")))
            .map(|entry| entry.path().to_string_lossy().into_owned())
            .collect();
        if found.is_empty() {
            return Err(Failure::usage(format!("there is no scene in `{name}`")));
        }
        found.sort();
        files.append(&mut found);
    }
    Ok(files)
}

/// Collects the inputs of a command. Folders are searched only if `scans` is set. Otherwise they stay in the list,
/// and reading them gives the error.
pub(crate) fn collect(
    files: &[PathBuf],
    args: &ProgramArgs,
    sources: &SourceArgs,
    scans: bool,
) -> Result<Inputs, Failure> {
    let engines = Engines::new(sources)?;
    let mut inputs = Inputs::default();
    let mut named: Vec<PathBuf> = Vec::new();
    for file in files {
        if scans && file.is_dir() {
            let mut search = search::folder(file, &engines)?;
            if args.stage.is_some() {
                search.take_without_stage();
            }
            if search.found.is_empty() {
                inputs.empty_folders.push(file.to_string_lossy().into_owned());
            }
            for path in &search.found {
                let folder =
                    path.strip_prefix(file).or(Ok::<_, ()>(path)).ok().and_then(Path::parent).unwrap_or(Path::new(""));
                inputs.below.insert(path.clone(), folder.to_owned());
            }
            inputs.found.extend(search.found.iter().cloned());
            inputs.left.extend(search.left);
            named.extend(search.found);
            named.extend(search.unreadable);
        } else {
            named.push(file.clone());
        }
    }
    let by_name: BTreeSet<PathBuf> = files.iter().filter(|file| !file.is_dir()).map(|name| identity(name)).collect();
    if !by_name.is_empty() {
        inputs.found.retain(|name| !by_name.contains(&identity(name)));
        inputs.left.retain(|left| !by_name.contains(&identity(&left.path)));
    }
    let mut in_programs = BTreeSet::new();
    let mut groups = Vec::new();
    for program in &args.programs {
        let names: Vec<&str> = program.split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
        if names.is_empty() {
            return Err(Failure::usage("--program names no file").help("write `--program a.vert,b.frag`"));
        }
        let mut own = BTreeSet::new();
        let mut listed = Vec::new();
        for name in names.into_iter().filter(|name| own.insert(identity(Path::new(name)))) {
            listed.extend(
                stages_of(Path::new(name), args, &engines, false)?.into_iter().filter(|input| !input.is_later()),
            );
        }
        in_programs.extend(own);
        let group = Group::new(listed.first().map(Input::stem).unwrap_or_default(), listed);
        check_program(&group, files)?;
        if let [input] = group.inputs.as_slice() {
            inputs.lone_programs.push(input.name.clone());
        }
        groups.push(group);
    }
    let mut seen = BTreeSet::new();
    let alone = named.len() == 1 && args.programs.is_empty();
    let mut listed = Vec::new();
    for name in &named {
        let identity = identity(name);
        if !in_programs.contains(&identity) && seen.insert(identity) {
            listed.extend(stages_of(name, args, &engines, alone)?);
        }
    }
    let is_found = |input: &Input| input.path.as_ref().is_some_and(|path| inputs.found.contains(path));
    inputs.groups = without_gaps(group(listed), &|group| group.inputs.iter().any(is_found));
    inputs.n_by_names = inputs.groups.len();
    inputs.groups.extend(groups);
    Ok(inputs)
}

/// Refuses a `--program` of one stage with a file of another stage after it: a space is where a comma is meant.
fn check_program(group: &Group, files: &[PathBuf]) -> Result<(), Failure> {
    let [input] = group.inputs.as_slice() else { return Ok(()) };
    let is_other = |file: &&PathBuf| {
        file.is_file()
            && stages::by_name(file).is_some_and(|stage| stage != input.stage)
            && identity(file) != identity(Path::new(&input.name))
    };
    let Some(other) = files.iter().find(is_other) else { return Ok(()) };
    let (first, second) = (&input.name, other.display());
    Err(Failure::usage(format!("`--program {first}` names one file, so that `{second}` is not part of the program"))
        .help(format!("write `--program {first},{second}`")))
}

/// The program of these files, whatever their names are.
pub(crate) fn program(names: &[String], args: &ProgramArgs, sources: &SourceArgs) -> Result<Group, Failure> {
    let engines = Engines::new(sources)?;
    let mut listed = Vec::new();
    for name in names {
        listed.extend(stages_of(Path::new(name), args, &engines, false)?.into_iter().filter(|input| !input.is_later()));
    }
    Ok(in_pipeline_order(Group::new(listed.first().map(Input::stem).unwrap_or_default(), listed)))
}

/// A key that is equal for two names of the same file.
pub(crate) fn identity(name: &Path) -> PathBuf {
    if name.as_os_str() == STDIN {
        PathBuf::from(STDIN)
    } else {
        fs::canonicalize(name).unwrap_or_else(|_| name.into())
    }
}

/// The stages of a file: one, unless it contains several.
fn stages_of(path: &Path, args: &ProgramArgs, engines: &Engines, alone: bool) -> Result<Vec<Input>, Failure> {
    let given = args.stage.map(Stage::from);
    if path.as_os_str() == STDIN {
        let stage = given.ok_or_else(|| {
            Failure::usage("cannot tell the shader stage of standard input").help("add `--stage vertex` or another")
        })?;
        return Ok(vec![Input { name: SHOWN_STDIN.to_owned(), path: None, stage, part: None }]);
    }
    let name = &path.to_string_lossy().into_owned();
    let told = stages::by_name(path);
    if told.is_none() {
        let parts = parts(path);
        let wanted = |input: &Input| given.is_none_or(|stage| stage == input.stage);
        if parts.iter().any(wanted) {
            return Ok(parts.into_iter().filter(wanted).collect());
        }
    }
    let stage = if alone { given.or(told) } else { told.or(given) }.or_else(|| engines.stage(path));
    // Reading reports what is not a readable file; its stage does not matter then.
    let stage = stage.or_else(|| (!path.is_file()).then_some(Stage::Vertex));
    let unread = stages::unread(path).filter(|_| stage.is_none());
    if let Some(unread) = unread {
        return Err(Failure::usage(format!("glisten does not read {unread} shaders, such as `{name}`")));
    }
    match stage {
        Some(stage) => Ok(vec![Input { name: name.to_owned(), path: Some(path.to_owned()), stage, part: None }]),
        None => Err(Failure::usage(format!("cannot tell the shader stage of `{name}`")).help(match Host::of(path) {
            Some(_) => "`glisten lint --embedded` reads the shaders in its strings".to_owned(),
            None if path.extension().is_some_and(|extension| extension == "toml") => {
                "`glisten verify` and `glisten render` take scenes; this command takes the shaders that a scene names"
                    .to_owned()
            }
            None => match engines.unknown_stage(path) {
                Some(stage) => format!(
                    "`stage = {stage:?}` of glisten.toml is none: there are `vertex`, `fragment` and `geometry`"
                ),
                None => format!("add `--stage vertex` or another, or name it {}", stages::all_extensions()),
            },
        })),
    }
}

/// The stages in a file that contains several.
pub(crate) fn parts(path: &Path) -> Vec<Input> {
    let name = path.to_string_lossy();
    files::read_source(&name, Some(path)).map_or_else(|_| Vec::new(), |text| parts_in(path, &text))
}

/// The stages in the text of a file that contains several.
pub(crate) fn parts_in(path: &Path, text: &str) -> Vec<Input> {
    let name = path.to_string_lossy();
    let mut inputs = Vec::new();
    for (index, member) in members(Some(path), text).into_iter().enumerate() {
        let part = PartOf { index, name: member.name, string: None };
        let input =
            |stage| Input { name: name.to_string(), path: Some(path.to_owned()), stage, part: Some(part.clone()) };
        inputs.extend(member.parts.iter().map(|part| input(part.stage)));
    }
    inputs
}

/// Groups files by folder and stem; each stage occurs at most once in a group. What tessellation stages stand between is no pair.
pub(crate) fn group(inputs: Vec<Input>) -> Vec<Group> {
    let mut groups: Vec<((PathBuf, String, String), Group)> = Vec::new();
    let mut of_key: BTreeMap<(PathBuf, String, String), Vec<usize>> = BTreeMap::new();
    let mut folders: BTreeMap<PathBuf, PathBuf> = BTreeMap::new();
    for input in inputs {
        let folder = input.path.as_deref().and_then(Path::parent).map(Path::to_owned).unwrap_or_default();
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        let real = |folder: &PathBuf| fs::canonicalize(folder).unwrap_or_else(|_| folder.clone());
        let folder = folders.entry(folder).or_insert_with_key(real).clone();
        // The stages of one file belong to each other, whatever files of the same stem there are.
        let own = input.part.as_ref().map_or(String::new(), |part| format!("{}:{}", input.name, part.index));
        let key = (folder, input.stem(), own);
        let fits = |group: &Group| group.inputs.iter().all(|other| other.stage != input.stage);
        let known = of_key.entry(key.clone()).or_default();
        let at = known.iter().copied().find(|&at| groups.get(at).is_some_and(|(_, group)| fits(group)));
        match at.and_then(|at| groups.get_mut(at)) {
            Some((_, group)) => group.inputs.push(input),
            None => {
                known.push(groups.len());
                groups.push((key, Group::new(input.stem(), vec![input])));
            }
        }
    }
    let groups = groups.into_iter().flat_map(|((folder, stem, own), group)| {
        if own.is_empty() && group.inputs.len() > 1 && stages::is_tessellated(&folder, &stem) {
            let alone = |input: Input| Group::new(group.name.clone(), vec![input]);
            group.inputs.iter().cloned().map(alone).collect()
        } else {
            vec![group]
        }
    });
    groups.map(in_pipeline_order).collect()
}

/// These groups, with each stage alone where the names of files form a program, and the text of another file in the folder shows that a stage
/// is missing in it: its name tells none.
pub(crate) fn without_gaps(groups: Vec<Group>, is_guess: &dyn Fn(&Group) -> bool) -> Vec<Group> {
    let mut of_folder: BTreeMap<PathBuf, Vec<PathBuf>> = BTreeMap::new();
    let mut has_gap = |group: &Group| {
        let has_inner = group.inputs.iter().any(|input| input.stage == Stage::Geometry);
        if !group.has_files() || has_inner || !is_guess(group) {
            return false;
        }
        let folder = group.inputs.first().and_then(|input| input.path.as_deref()?.parent()).unwrap_or(Path::new(""));
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let inner = of_folder.entry(folder.to_owned()).or_insert_with_key(|folder| stages::inner_stages(folder));
        inner.iter().any(|file| stages::may_be_of(file, &group.name))
    };
    let mut all = Vec::with_capacity(groups.len());
    for group in groups {
        if has_gap(&group) {
            let name = group.name;
            all.extend(group.inputs.into_iter().map(|input| Group::new(name.clone(), vec![input])));
        } else {
            all.push(group);
        }
    }
    all
}

/// Sorts the stages in pipeline order, so that the order on the command line does not matter.
fn in_pipeline_order(mut group: Group) -> Group {
    group.inputs.sort_by_key(|input| input.stage);
    group
}

#[cfg(test)]
mod tests {
    use super::{Input, group};
    use glisten_front::hir::Stage;
    use glisten_sources::stages;
    use std::path::{Path, PathBuf};

    fn inputs(names: &[&str]) -> Vec<Input> {
        let input = |name: &&str| Input {
            name: (*name).to_owned(),
            path: Some(PathBuf::from(name)),
            stage: stages::by_name(Path::new(name)).expect("the name tells the stage"),
            part: None,
        };
        names.iter().map(input).collect()
    }

    #[test]
    fn files_are_grouped_by_folder_and_stem() {
        let groups = group(inputs(&["b.frag", "a.vert", "x/a.frag", "b.vs", "a.frag", "b.vert"]));
        let shown: Vec<Vec<&str>> =
            groups.iter().map(|group| group.inputs.iter().map(|input| input.name.as_str()).collect()).collect();
        assert_eq!(shown, [vec!["b.vs", "b.frag"], vec!["a.vert", "a.frag"], vec!["x/a.frag"], vec!["b.vert"]]);
        assert!(groups[2].is_lone() && !groups[0].is_lone());
    }

    #[test]
    fn stems_leave_out_what_tells_the_stage() {
        for (name, stem, stage) in [
            ("dir/phong.vert", "phong", Some(Stage::Vertex)),
            ("phong.vert.glsl", "phong", Some(Stage::Vertex)),
            ("a.b.fs", "a.b", Some(Stage::Fragment)),
            ("lib.glsl", "lib", None),
            ("X.GEOM", "X", Some(Stage::Geometry)),
            ("a/phong_vs.glsl", "phong", Some(Stage::Vertex)),
            ("phong-FS.GLSL", "phong", Some(Stage::Fragment)),
            ("PhongVert.glsl", "Phong", Some(Stage::Vertex)),
            ("lightFS.glsl", "light", Some(Stage::Fragment)),
            ("advert.glsl", "advert", None),
            ("vs_phong.glsl", "phong", Some(Stage::Vertex)),
            ("deferred_light_vertex.glsl", "deferred_light", Some(Stage::Vertex)),
            ("fragment.glsl", "program", Some(Stage::Fragment)),
            ("a.vertex", "a", Some(Stage::Vertex)),
            ("a.fragmentshader", "a", Some(Stage::Fragment)),
            ("a.ps", "a", None),
            ("old.vp", "old", Some(Stage::Vertex)),
            ("old_fp.glsl", "old", Some(Stage::Fragment)),
            ("deferred-f.sdr", "deferred", Some(Stage::Fragment)),
            ("light_v.glsl", "light_v", None),
            ("waves.glsl", "waves", None),
            ("_vs.glsl", "_vs", None),
        ] {
            assert_eq!(stages::stem(Path::new(name)), stem, "{name}");
            assert_eq!(stages::by_name(Path::new(name)), stage, "{name}");
        }
    }
}

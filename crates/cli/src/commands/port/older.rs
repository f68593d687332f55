//! [`Older`]: included files that have the names of the host's and are from before the host had its blocks.
//!
//! *In:* the includes that the programs of a pack name, as their compiler finds them. *Out:* which of those files are older, the places in
//! the new pack that they go to, and a host that has its blocks elsewhere. *Holds:* a pack whose files are of the host's age has none.
//!
//! Under their names, the host reads its own files: `<fog.glsl>` of an older game has functions that the host's has no more, and no
//! block. So the files that a pack includes of such a game become files of the pack, in a folder of their own; and a file of the pack that
//! would hide the host's moves there, too.

use crate::files;
use glisten_front::source::Included;
use glisten_port::Host;
use glisten_upgrade::{moved_path, plain};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The folder of older files.
const OLDER: &str = "older";
/// The folder of the blocks of the host whose files older ones would hide.
const BLOCKS: &str = "blocks";

/// The older files of a pack.
#[derive(Clone, Default)]
pub(super) struct Older {
    pack: PathBuf,
    /// Their names.
    files: Arc<BTreeSet<String>>,
    /// Whether the game, of which the pack includes files, is older.
    is_game_older: bool,
    /// The paths of the host's files that they hide, without a namespace.
    hidden: Arc<BTreeSet<String>>,
    /// The new places of files that were read, and the old ones.
    moved: Arc<Mutex<BTreeMap<String, String>>>,
}

impl Older {
    /// The older files among those that were found.
    pub(super) fn new(pack: &Path, host: &Host, found: &BTreeMap<(String, String), Included>) -> Self {
        let (mut older, mut hidden, mut is_game_older) = (BTreeSet::new(), BTreeSet::new(), false);
        for ((_, path), included) in found {
            let block = host.dialect.as_ref().and_then(|dialect| dialect.block_of(path));
            if block.is_none_or(|block| block.is_in(&included.text)) {
                continue;
            }
            is_game_older |= !Path::new(&included.name).starts_with(pack);
            hidden.insert(plain(path).to_owned());
            older.insert(included.name.clone());
        }
        // What nothing includes would hide the host's file, too.
        let places = folders(pack, found.keys().map(|(from, _)| Path::new(from)));
        for block in host.dialect.iter().flat_map(|dialect| &dialect.blocks) {
            let Some(include) = block.include.as_deref().map(plain) else { continue };
            for path in places.iter().map(|folder| folder.join(include)).filter(|path| path.is_file()) {
                let name = path.to_string_lossy().into_owned();
                let bytes = files::read(&name, &path);
                if bytes.is_ok_and(|bytes| !block.is_in(&String::from_utf8_lossy(&bytes))) {
                    hidden.insert(include.to_owned());
                    older.insert(name);
                }
            }
        }
        let (files, hidden) = (Arc::new(older), Arc::new(hidden));
        Self { pack: pack.to_owned(), files, is_game_older, hidden, moved: Arc::default() }
    }

    /// The host, with the blocks in files that nothing hides.
    pub(super) fn host(&self, host: &Host) -> Host {
        let mut host = host.clone();
        for block in host.dialect.iter_mut().flat_map(|dialect| &mut dialect.blocks) {
            let Some(include) = block.include.clone().filter(|include| self.hidden.contains(plain(include))) else {
                continue;
            };
            let new = moved_path(&include, BLOCKS);
            block.line = block.line.replace(&include, &new);
            block.include = Some(new);
        }
        host
    }

    /// The place of an included file in the new pack, if it is older.
    pub(super) fn place(&self, from: &str, path: &str, file: &str) -> Option<String> {
        let new = match Path::new(file).starts_with(&self.pack) {
            true if self.files.contains(file) => PathBuf::from(moved_path(file, OLDER)),
            false if self.is_game_older && !file.starts_with('<') => self.included(from, &moved_path(path, OLDER)),
            _ => return None,
        };
        let new = new.to_string_lossy().into_owned();
        self.moved.lock().unwrap_or_else(PoisonError::into_inner).insert(new.clone(), file.to_owned());
        Some(new)
    }

    /// The place of an included file, as a file of the pack names it: in the folder of its namespace, or next to sources without one.
    fn included(&self, from: &str, path: &str) -> PathBuf {
        let (namespace, path) = path.split_once(':').unwrap_or(("minecraft", path));
        let own = || Path::new(from).ancestors().skip(1).take_while(|folder| folder.starts_with(&self.pack));
        let named =
            |folder: &Path, names: &[&str]| folder.file_name().is_some_and(|name| names.iter().any(|one| name == *one));
        let shaders = match own().find(|folder| named(folder, &["shaders"])) {
            Some(shaders) => match shaders.ancestors().nth(2).filter(|assets| named(assets, &["assets"])) {
                Some(assets) => assets.join(namespace).join("shaders"),
                None => shaders.to_owned(),
            },
            None => {
                let folder = own().next().unwrap_or(&self.pack);
                let kind = own().find(|folder| named(folder, &["core", "post", "program", "include"]));
                kind.and_then(Path::parent).unwrap_or(folder).to_owned()
            }
        };
        shaders.join("include").join(path)
    }

    /// The older files of the pack that no program reads, with their new places.
    pub(super) fn unread(&self) -> Vec<(String, String)> {
        let read: BTreeSet<String> = self.moved().into_values().collect();
        let own = self.files.iter().filter(|file| Path::new(file).starts_with(&self.pack) && !read.contains(*file));
        own.map(|file| (file.clone(), moved_path(file, OLDER))).collect()
    }

    /// The files that moved: their new places, and the old ones.
    pub(super) fn moved(&self) -> BTreeMap<String, String> {
        self.moved.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The new places, each with the folder that it is in.
    pub(super) fn folders(&self) -> BTreeMap<String, String> {
        self.moved().into_keys().map(|new| (new, OLDER.to_owned())).collect()
    }

    /// The files of blocks that a new text includes: each place, and the text.
    pub(super) fn blocks<'a>(
        &'a self,
        host: &'a Host,
        file: &'a str,
        text: &'a str,
    ) -> impl Iterator<Item = (PathBuf, String)> + 'a {
        let blocks = host.dialect.iter().flat_map(|dialect| &dialect.blocks);
        let used =
            blocks.filter(|block| text.contains(&block.line)).filter_map(|block| Some((block, block.include.clone()?)));
        let own = used.filter(|(_, include)| include.contains(&format!("{BLOCKS}/")));
        own.map(move |(block, include)| {
            let text = format!("{}\n\n{}", host.target.version_line(), block.declaration());
            (self.included(file, &include), text)
        })
    }
}

/// The folders of included files that a pack has next to the sources that include.
fn folders<'a>(pack: &Path, sources: impl Iterator<Item = &'a Path>) -> BTreeSet<PathBuf> {
    let own = sources.filter(|from| from.starts_with(pack));
    let folders = own.flat_map(|from| from.ancestors().take_while(|folder| folder.starts_with(pack)));
    let shaders = folders.filter(|folder| folder.file_name().is_some_and(|name| name == "shaders"));
    shaders.map(|folder| folder.join("include")).collect()
}

#[cfg(test)]
mod tests {
    use super::Older;
    use glisten_front::source::Included;
    use glisten_port::find_host;
    use std::path::Path;

    fn older(files: &[(&str, &str, &str)]) -> Older {
        let found = files.iter().map(|(path, name, text)| {
            let included = Included { name: (*name).to_owned(), text: (*text).into() };
            (("/p/assets/minecraft/shaders/core/a.vsh".to_owned(), (*path).to_owned()), included)
        });
        let found = found.collect();
        Older::new(Path::new("/p"), find_host("minecraft-26.2").expect("it is there"), &found)
    }

    #[test]
    fn files_without_the_block_of_their_name_move() {
        let old = "float linear_fog(float a) { return a; } // uniform Fog";
        let (game, own) = ("/game/include/fog.glsl", "/p/assets/minecraft/shaders/include/light.glsl");
        let older = older(&[("fog.glsl", game, old), ("minecraft:light.glsl", own, "vec3 light();")]);
        let from = "/p/assets/mine/shaders/core/a.fsh";
        let place = |path, file| older.place(from, path, file);
        let at = |name: &str| Some(format!("/p/assets/minecraft/shaders/include/older/{name}"));
        assert_eq!(place("fog.glsl", game), at("fog.glsl"));
        assert_eq!(place("minecraft:matrix.glsl", "/game/include/matrix.glsl"), at("matrix.glsl"), "all of the game");
        assert_eq!(place("minecraft:light.glsl", own), at("light.glsl"));
        assert_eq!(place("mine.glsl", "/p/assets/minecraft/shaders/include/mine.glsl"), None);
        assert_eq!(place("glisten/phong.glsl", "<glisten/phong.glsl>"), None);
        let host = older.host(find_host("minecraft-26.2").expect("it is there"));
        let lines: Vec<String> = host.dialect.expect("it has one").blocks.into_iter().map(|block| block.line).collect();
        assert!(lines.contains(&"#moj_import <minecraft:blocks/fog.glsl>".to_owned()), "{lines:?}");
        assert!(lines.contains(&"#moj_import <minecraft:globals.glsl>".to_owned()), "{lines:?}");
    }

    #[test]
    fn files_of_the_age_of_the_host_stay() {
        let older = older(&[("fog.glsl", "/game/include/fog.glsl", "layout(std140) uniform Fog { vec4 FogColor; };")]);
        assert_eq!(older.place("/p/shaders/core/a.fsh", "fog.glsl", "/game/include/fog.glsl"), None);
    }
}

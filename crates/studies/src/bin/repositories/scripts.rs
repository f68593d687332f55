//! Shaders in pages: `<script type="x-shader/x-vertex" id="..">`, as the programs of WebGL keep them.
//!
//! *In:* a folder. *Out:* a folder with a file for each script. *Holds:* scripts of a page whose ids differ only in the words for the
//! stage have one stem, so that they form a program.

use std::path::Path;

/// The words in ids that say the stage.
const WORDS: &[&str] = &["vertexshader", "fragmentshader", "vertex", "fragment", "shader", "vert", "frag", "vs", "fs"];

/// Writes the scripts of all files with this ending. Returns the folder.
pub(crate) fn extract(root: &Path, ending: &str, to: &Path) -> Result<String, String> {
    std::fs::create_dir_all(to).map_err(|error| error.to_string())?;
    for entry in ignore::WalkBuilder::new(root).sort_by_file_name(Ord::cmp).build().filter_map(Result::ok) {
        let path = entry.path();
        if !path.to_string_lossy().ends_with(ending) {
            continue;
        }
        let text = String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned();
        let page = path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace(['/', '.'], "_");
        for (index, (stage, id, script)) in scripts(&text).into_iter().enumerate() {
            let name = match id.as_str() {
                "" => format!("{page}_{index}.{stage}"),
                id => format!("{page}_{id}.{stage}"),
            };
            std::fs::write(to.join(name), script).map_err(|error| error.to_string())?;
        }
    }
    Ok(to.to_string_lossy().into_owned())
}

/// The scripts of a page: the stage, the id without the words for the stage, the text.
fn scripts(page: &str) -> Vec<(&'static str, String, &str)> {
    let mut found = Vec::new();
    for part in page.split("<script").skip(1) {
        let Some((tag, rest)) = part.split_once('>') else { continue };
        let stage = match () {
            () if tag.contains("x-vertex") => "vert",
            () if tag.contains("x-fragment") => "frag",
            () => continue,
        };
        let Some((script, _)) = rest.split_once("</script") else { continue };
        let id = tag.split_once("id=").map_or("", |(_, id)| id.trim_start_matches(['"', '\'']));
        let mut id = id.split(['"', '\'', ' ']).next().unwrap_or_default().to_ascii_lowercase().replace(['-', '_'], "");
        for word in WORDS {
            id = id.replace(word, "");
        }
        // A `#version` line must be the first.
        found.push((stage, id, script.trim_start()));
    }
    found
}

//! `-g`: the lines in SPIR-V are those of the files on disk, including included files.

use std::path::Path;
use std::process::Command;

const PART: &str = "// A part.\n\nfloat twice(float x) {\n    float y = x + x;\n    return y * x;\n}\n";
const MAIN: &str = "#version 150\n#extension GL_ARB_shading_language_include : enable\nin float v;\nout vec4 c;\n\
    #include \"part.glsl\"\n\nvoid main() {\n    float w = twice(v) * v;\n    c = vec4(w);\n}\n";

/// The string at the end of an instruction.
fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8(bytes).expect("names and texts are UTF-8")
}

/// The id, name and text of a file.
type File = (u32, String, String);

/// The files with their texts, and all lines with the name of their file.
fn lines(words: &[u32]) -> (Vec<File>, Vec<(String, u32)>) {
    let (mut files, mut lines) = (Vec::<File>::new(), Vec::new());
    let mut rest = &words[5..];
    while let Some(first) = rest.first() {
        let (instruction, behind) = rest.split_at((first >> 16) as usize);
        match first & 0xffff {
            7 => files.push((instruction[1], text(&instruction[2..]), String::new())),
            3 => {
                let file = files.iter_mut().find(|(id, ..)| *id == instruction[3]).expect("the file has a name");
                file.2 = text(&instruction[4..]);
            }
            8 => {
                let (_, name, _) = files.iter().find(|(id, ..)| *id == instruction[1]).expect("the file has a name");
                lines.push((name.clone(), instruction[2]));
            }
            _ => {}
        }
        rest = behind;
    }
    (files, lines)
}

fn compiled(folder: &Path) -> Vec<u32> {
    std::fs::write(folder.join("part.glsl"), PART).expect("written");
    std::fs::write(folder.join("main.frag"), MAIN).expect("written");
    let run = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["compile", "-q", "-g", "--target", "spirv", "main.frag", "-o", "out"])
        .current_dir(folder)
        .output()
        .expect("the program runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let bytes = std::fs::read(folder.join("out/main.frag.spv")).expect("the words are written");
    bytes.chunks(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

#[test]
fn lines_of_included_files_are_their_own() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let words = compiled(folder.path());
    let (files, lines) = lines(&words);
    let named: Vec<(&str, &str)> = files.iter().map(|(_, name, text)| (name.as_str(), text.as_str())).collect();
    assert_eq!(named, [("main.frag", MAIN), ("part.glsl", PART)]);
    let of = |name: &str| {
        let mut of: Vec<u32> = lines.iter().filter(|(file, _)| file == name).map(|(_, line)| *line).collect();
        of.dedup();
        of
    };
    assert_eq!(of("part.glsl"), [4, 5]);
    assert!(of("main.frag").contains(&8) && of("main.frag").contains(&9), "{lines:?}");
    assert!(of("main.frag").iter().all(|line| *line <= 10), "{lines:?}");
    let mut collected = crate::emit::Collected::new();
    collected.add("lines of two files", glisten_emit::Emitted::Words(words));
    collected.validate();
}

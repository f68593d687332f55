//! Files whose stages begin with a line of their own: `#shader vertex`, `#type vertex`, `[vertex]`, `-- Vertex`, and others.
//!
//! *In:* a text. *Out:* a part for each stage: the lines from its mark to the next, and the lines before the first mark, which
//! belong to all. *Holds:* all marks of a file are of one kind.

use super::code::without_comments;
use super::part::Part;
use super::profile::stage_named;
use glisten_front::Stage;
use std::collections::BTreeMap;
use std::ops::Range;

/// A kind of mark.
struct Mark {
    /// Before the name of the stage.
    before: &'static str,
    /// After it.
    after: &'static str,
    /// Whether a file with one such mark is combined; others have at least two stages.
    certain: bool,
}

const fn mark(before: &'static str, after: &'static str, certain: bool) -> Mark {
    Mark { before, after, certain }
}

static MARKS: &[Mark] = &[
    mark("#shader ", "", true),
    mark("#type ", "", true),
    mark("#stage ", "", true),
    mark("#pragma stage ", "", true),
    mark("#pragma shader_stage(", ")", false),
    mark("#pragma ", "", false),
    mark("[", "]", false),
    mark("-- ", "", false),
    mark("--", "--", false),
    mark("@", "", false),
    mark("###", "", false),
    mark("#", "", false),
    mark("//[", "]", false),
    mark("// @", "", false),
    mark("//@", "", false),
];

/// A line that begins a part; the stage is `None` for one that glisten does not have (`compute`).
struct Found {
    line: Range<usize>,
    stage: Option<Stage>,
}

impl Mark {
    /// The stage that a line marks.
    fn read(&self, line: &str) -> Option<Option<Stage>> {
        let name = line.strip_prefix(self.before)?.strip_suffix(self.after)?.trim().trim_matches(['"', ':']);
        // The names of glsw are `Program.Vertex.GL3`.
        name.split('.').find_map(|word| stage_named(word).map(Some).or(other(word)))
    }

    fn marks(&self, text: &str, code: &str) -> Vec<Found> {
        let (mut at, mut marks) = (0, Vec::new());
        let searched = if self.before.starts_with("//") { text } else { code };
        for line in searched.split_inclusive('\n') {
            let words = line.split_whitespace().collect::<Vec<_>>().join(" ");
            if let Some(stage) = self.read(&words) {
                marks.push(Found { line: at..at + line.len(), stage });
            }
            at += line.len();
        }
        marks
    }
}

/// A stage that glisten does not have.
fn other(word: &str) -> Option<Option<Stage>> {
    static OTHERS: &[&str] = &[
        "compute",
        "cs",
        "tesscontrol",
        "tesseval",
        "tess_control",
        "tess_eval",
        "hull",
        "domain",
        "mesh",
        "task",
        "raygen",
    ];
    OTHERS.iter().any(|other| other.eq_ignore_ascii_case(word)).then_some(None)
}

/// The parts of a file with marks.
pub(super) fn parts(text: &str) -> Option<Vec<Part>> {
    let code = without_comments(text);
    MARKS.iter().find_map(|kind| {
        let marks = kind.marks(text, &code);
        let mut stages: Vec<Stage> = marks.iter().filter_map(|mark| mark.stage).collect();
        stages.sort();
        stages.dedup();
        let enough = stages.len() >= 2 || kind.certain && !stages.is_empty();
        enough.then(|| cut(text, &marks))
    })
}

/// The text cut at its marks.
fn cut(text: &str, marks: &[Found]) -> Vec<Part> {
    let mut parts: BTreeMap<Stage, Part> = BTreeMap::new();
    for stage in marks.iter().filter_map(|mark| mark.stage) {
        parts.entry(stage).or_insert(Part { stage, others: Vec::new(), defines: Vec::new() });
    }
    let ends = marks.iter().skip(1).map(|next| next.line.start).chain([text.len()]);
    for (mark, end) in marks.iter().zip(ends) {
        for part in parts.values_mut() {
            let own = mark.stage == Some(part.stage);
            part.others.push(mark.line.start..if own { mark.line.end } else { end });
        }
    }
    parts.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::parts;
    use glisten_front::Stage;

    fn texts(text: &str) -> Vec<(Stage, String)> {
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        parts(text).unwrap_or_default().iter().map(|part| (part.stage, words(&part.text(text)))).collect()
    }

    #[test]
    fn marks_cut_a_file() {
        let (vertex, fragment) = ((Stage::Vertex, "c a".to_owned()), (Stage::Fragment, "c b".to_owned()));
        for (first, second) in [
            ("#shader vertex", "#shader fragment"),
            ("#type vertex", "#type pixel"),
            ("#pragma stage vertex", "#pragma stage fragment"),
            ("#pragma vertex", "#pragma fragment"),
            ("[vertex]", "[fragment]"),
            ("  [VertexShader]", "[FragmentShader]  "),
            ("-- Water.Vertex.GL3", "-- Water.Fragment.GL3"),
            ("@vertex", "@fragment"),
            ("#VERTEX", "#FRAGMENT"),
            ("//[vertex]", "//[fragment]"),
        ] {
            let text = format!("c\n{first}\na\n{second}\nb\n");
            assert_eq!(texts(&text), [vertex.clone(), fragment.clone()], "{first}");
        }
        assert_eq!(texts("#shader fragment\nb\n#shader compute\nx\n"), [(Stage::Fragment, "b".into())]);
    }

    #[test]
    fn other_files_are_whole() {
        for text in
            ["#pragma vertex vert\n#pragma fragment frag\n", "/*\n[vertex]\n[fragment]\n*/", "a[vs];\n-- vertex;\n"]
        {
            assert!(parts(text).is_none(), "{text}");
        }
    }

    #[test]
    fn lines_stay() {
        let text = "#shader vertex\né\n#shader fragment\nb\n";
        let parts = parts(text).unwrap_or_default();
        assert!(parts.iter().all(|part| part.text(text).len() == text.len()));
        assert_eq!(parts[1].text(text).lines().nth(3), Some("b"));
    }
}

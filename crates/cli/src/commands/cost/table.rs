//! The table of `glisten cost`.
//!
//! *In:* the cost of a program, and its texts. *Out:* lines for people.

use glisten_cost::{CLASSES, Counts, LineCost, ProgramCost, StageCost};
use glisten_front::source::SourceMap;

/// The lines that are shown, if not all are.
const DEAREST: usize = 6;
/// The width of a column.
const COLUMN: usize = 11;
/// The width of the first column.
const HEAD: usize = 28;

/// The table of a program.
pub(crate) fn table(cost: &ProgramCost, sources: &SourceMap, all: bool) -> String {
    let mut text = format!("{}\n", cost.program);
    let varyings = cost.varyings;
    if cost.stages.len() > 1 {
        let (registers, components) = (counted(varyings.registers, "register"), varyings.components);
        text += &format!("  interpolated: {registers} of varyings, {components} components\n");
    }
    for stage in &cost.stages {
        text += &of_stage(stage, sources, all);
    }
    text
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn row(head: &str, counts: &Counts) -> String {
    let columns: String = CLASSES.iter().map(|(_, of)| format!("{:>COLUMN$}", of(counts))).collect();
    format!("    {head:<HEAD$}{columns}")
}

fn of_stage(stage: &StageCost, sources: &SourceMap, all: bool) -> String {
    let names: String = CLASSES.iter().map(|(name, _)| format!("{name:>COLUMN$}")).collect();
    let title = format!("{}: {}", stage.stage, stage.file);
    let mut text = format!("\n  {title:<width$}{names}\n", width = HEAD + 2);
    for (head, counts) in [
        ("shortest path", &stage.shortest),
        ("longest path", &stage.longest),
        ("of it the same in a draw", &stage.uniform),
    ] {
        text += &format!("{}\n", row(head, counts));
    }
    for one in &stage.loops {
        let rounds = if one.least == one.most {
            counted(usize::try_from(one.most).unwrap_or(usize::MAX), "round")
        } else {
            format!("{} to {} rounds", one.least, one.most)
        };
        let known = match one.known {
            "counted" => "",
            "range" => ", by the range of its limit",
            "array" => ", by the size of an array that it indexes",
            _ => ", assumed: nothing limits it",
        };
        text += &format!("    loop at {}:{}: {rounds}{known}\n", one.file, one.line);
    }
    for late in &stage.early_z {
        text += &format!("    no early depth test: `{}` at {}:{}\n", late.what, late.file, late.line);
    }
    text + &lines(stage, sources, all)
}

/// The lines of a stage: all in their order, or the dearest first.
fn lines(stage: &StageCost, sources: &SourceMap, all: bool) -> String {
    let mut rows: Vec<&LineCost> = stage.lines.iter().collect();
    if !all {
        rows.retain(|row| row.longest.weight() > 0);
        rows.sort_by_key(|row| std::cmp::Reverse(row.longest.weight()));
        rows.truncate(DEAREST);
    }
    let mut text = String::new();
    for line in rows {
        let code = sources.file_of(line.span).and_then(|file| sources.file(file).line(line.line)).unwrap_or("");
        let place = format!("{}:{}", line.file, line.line);
        text += &format!("{}  {}\n", row(&place, &line.longest), code.trim());
    }
    text
}

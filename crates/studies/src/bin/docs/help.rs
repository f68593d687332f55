//! The help of every command, as one page.
//!
//! *In:* the program. *Out:* Markdown: a heading and a text block for each command, in the order of `glisten help`.

/// Options that every command has. `glisten help` shows them; the page does not repeat them.
static GLOBAL: &[&str] = &["-q, --quiet", "--color <WHEN>", "-h, --help"];

/// The page of all commands. `run` returns what the program prints for the arguments.
///
/// # Errors
/// The program cannot run.
pub(crate) fn commands(run: impl Fn(&[&str]) -> Result<String, String>) -> Result<String, String> {
    let overview = run(&["--help"])?;
    let mut page = format!("```text\n{}\n```\n", overview.trim_end());
    for name in names(&overview) {
        let help = run(&["help", name])?;
        page.push_str(&section(2, name, &help));
        for inner in names(&help) {
            let help = run(&["help", name, inner])?;
            page.push_str(&section(3, &format!("{name} {inner}"), &help));
        }
    }
    Ok(page)
}

/// The help of one command under its heading.
fn section(level: usize, name: &str, help: &str) -> String {
    let help = without_global(help);
    format!("\n{} `glisten {name}`\n\n```text\n{}\n```\n", "#".repeat(level), help.trim_end())
}

/// The names under `Commands:` but `help`, which are indented by two.
fn names(overview: &str) -> impl Iterator<Item = &str> {
    let listed = overview.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    let rows = listed.take_while(|line| !line.is_empty()).filter_map(|line| line.strip_prefix("  "));
    let named = rows.filter(|row| !row.starts_with(' ')).filter_map(|row| row.split_whitespace().next());
    named.filter(|name| *name != "help")
}

/// A help without the options that all commands have, each of which goes on until the next option or heading.
fn without_global(help: &str) -> String {
    let mut kept = String::new();
    let mut leaving = false;
    for line in help.lines() {
        let is_option = line.trim_start().starts_with('-') && indent(line) < 8;
        let is_heading = !line.is_empty() && indent(line) == 0;
        if is_option || is_heading {
            leaving = is_option && GLOBAL.iter().any(|option| line.trim_start().starts_with(option));
        }
        if !leaving {
            kept.push_str(line.trim_end());
            kept.push('\n');
        }
    }
    kept.replace("Options:\nExamples:", "Examples:")
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

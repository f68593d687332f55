//! Finds and replaces the generated parts of a Markdown page.
//!
//! *In:* the text of a page, and a generator for each part. *Out:* the page with every part generated again. *Holds:*
//! text that a person wrote is unchanged.
//!
//! A part is a *region*, all lines between `<!-- docs: NAME -->` and `<!-- /docs -->`, or the output of a `$ glisten
//! ...` line in a `console` block. A line `...` in a shown output matches any lines; such an output is left
//! unchanged.

use std::fmt::Write;

/// Generates the parts of pages.
pub(crate) trait Maker {
    /// The lines of a region. `None` leaves the region as it is.
    ///
    /// # Errors
    /// The name is unknown, or the region cannot be generated.
    fn region(&mut self, name: &str) -> Result<Option<String>, String>;

    /// The output of a command. `None` leaves the shown output unchanged.
    ///
    /// # Errors
    /// The command cannot run.
    fn output(&mut self, command: &str) -> Result<Option<String>, String>;
}

const OPEN: &str = "<!-- docs: ";
const CLOSE: &str = "<!-- /docs -->";

/// The page with its parts generated again.
///
/// # Errors
/// A region without an end, or an error of the generator.
pub(crate) fn remake(page: &str, maker: &mut dyn Maker) -> Result<String, String> {
    let mut made = String::with_capacity(page.len());
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        push(&mut made, line);
        if let Some(name) = line.strip_prefix(OPEN).and_then(|rest| rest.strip_suffix(" -->")) {
            let mut old = String::new();
            loop {
                match lines.next() {
                    Some(CLOSE) => break,
                    Some(line) => push(&mut old, line),
                    None => return Err(format!("the region `{name}` has no end")),
                }
            }
            match maker.region(name)? {
                Some(text) => write!(made, "\n{}\n\n", text.trim()).map_err(|error| error.to_string())?,
                None => made.push_str(&old),
            }
            push(&mut made, CLOSE);
        } else if line == "```console" {
            let block: Vec<&str> = std::iter::from_fn(|| lines.next_if(|line| *line != "```")).collect();
            made.push_str(&console(&block, maker)?);
        }
    }
    Ok(made)
}

fn push(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// The lines of a `console` block with the outputs of its commands.
fn console(block: &[&str], maker: &mut dyn Maker) -> Result<String, String> {
    let mut made = String::new();
    let mut at = 0;
    while let Some(line) = block.get(at) {
        let shown: Vec<&str> = block.iter().skip(at + 1).take_while(|line| !line.starts_with("$ ")).copied().collect();
        push(&mut made, line);
        let command = line.strip_prefix("$ ").filter(|command| command.starts_with("glisten "));
        let elided = shown.contains(&"...");
        let output = match command {
            Some(command) if !elided && !shown.is_empty() => maker.output(command)?,
            _ => None,
        };
        match output {
            Some(text) => text.trim().lines().for_each(|line| push(&mut made, line.trim_end())),
            None => shown.iter().for_each(|line| push(&mut made, line)),
        }
        at += 1 + shown.len();
    }
    Ok(made)
}

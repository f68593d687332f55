//! [`Planted`]: a row of the table of faults.
//!
//! *In:* TOML. *Out:* rows. *Holds:* each has one expression between `«` and `»`.

/// A fault to plant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planted {
    /// Its description.
    pub name: String,
    /// Where it is: `parser`.
    pub phase: String,
    /// The file.
    pub file: String,
    /// The text before the expression, the expression, the text behind it.
    pub text: [String; 3],
    /// The expression in its place.
    pub faulty: String,
    /// Whether it shows only in what a GPU draws.
    pub device: bool,
}

/// Reads the table.
pub fn read(text: &str) -> Result<Vec<Planted>, String> {
    let table: toml::Table = text.parse().map_err(|error| format!("the table of faults: {error}"))?;
    let rows = table.get("fault").and_then(toml::Value::as_array).ok_or("the table has no `[[fault]]`")?;
    rows.iter().map(row).collect()
}

fn row(row: &toml::Value) -> Result<Planted, String> {
    let word = |key: &str| {
        let value = row.get(key).and_then(toml::Value::as_str).map(str::to_owned);
        value.ok_or_else(|| format!("a fault without `{key}`: {row}"))
    };
    let (name, text) = (word("name")?, word("text")?);
    let parts = text.split_once('«').and_then(|(before, rest)| Some((before, rest.split_once('»')?)));
    let (before, (expression, behind)) = parts.ok_or_else(|| format!("`{name}` has no expression between « and »"))?;
    Ok(Planted {
        name,
        phase: word("phase")?,
        file: word("file")?,
        text: [before, expression, behind].map(str::to_owned),
        faulty: word("faulty")?,
        device: row.get("device").and_then(toml::Value::as_bool).unwrap_or(false),
    })
}

//! Errors of TOML files that serde reads, with the nearest key.
//!
//! *In:* an error. *Out:* its message and a help text. *Not done here:* scenes, which have a reader of their own.

use glisten_front::diagnostic::did_you_mean;

/// The message of an error on one line, and a help text: the nearest of the keys or values that are there.
pub(super) fn explained(error: &toml::de::Error) -> (String, Option<String>) {
    let message = error.message().trim().replace('\n', ", ");
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let is_unknown = message.starts_with("unknown field") || message.starts_with("unknown variant");
    match quoted.split_first() {
        Some((name, known)) if is_unknown => {
            let near = did_you_mean(name, known.iter().copied());
            let keys = || known.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
            let help =
                near.map_or_else(|| format!("the keys here are {}", keys()), |near| format!("did you mean `{near}`?"));
            (format!("there is no key `{name}` here"), Some(help))
        }
        _ => (message, None),
    }
}

#[cfg(test)]
mod tests {
    use super::explained;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Table {
        #[expect(dead_code, reason = "only the keys matter")]
        files: Option<Vec<String>>,
        #[expect(dead_code, reason = "only the keys matter")]
        name: Option<String>,
    }

    #[test]
    fn the_nearest_key_is_named() {
        let told = |text: &str| explained(&toml::from_str::<Table>(text).expect_err(text));
        assert_eq!(told("fils = []"), ("there is no key `fils` here".into(), Some("did you mean `files`?".into())));
        assert_eq!(told("other = 1").1.as_deref(), Some("the keys here are `files`, `name`"));
        assert!(told("files = 1").0.contains("invalid type") && told("files = [").1.is_none());
    }
}

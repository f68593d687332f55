//! Parses the materials of Wavefront's MTL: `newmtl`, `Kd`, `Ks`, `Ke`, `Ns`, `illum`, `map_Kd`.
//!
//! *In:* text. *Out:* a [`Look`] for each material. *Holds:* everything else is ignored; options of a map are skipped.

use super::model::{Look, TextureSource};

/// Options of a map, with how many words follow at most.
static OPTIONS: &[(&str, usize)] = &[
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
    ("-type", 1),
];

/// Parses a library of materials.
///
/// # Errors
/// A sentence that names the line.
pub(crate) fn parse(text: &str) -> Result<Vec<Look>, String> {
    let mut looks: Vec<Look> = Vec::new();
    let mut has_gloss = true;
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if word == "newmtl" {
            looks.push(Look { specular: [0.0; 3], ..Look::plain(rest.trim()) });
            has_gloss = true;
            continue;
        }
        let Some(look) = looks.last_mut() else { continue };
        let at = |what: &str| format!("line {}: {what}", number + 1);
        let wrong = || at(&format!("`{word}` has one or three numbers"));
        match word {
            "Kd" => look.diffuse = color(rest).ok_or_else(wrong)?,
            "Ks" if has_gloss => look.specular = color(rest).ok_or_else(wrong)?,
            "Ke" => look.emission = color(rest).ok_or_else(wrong)?,
            "Ns" => look.shininess = scalar(rest).ok_or_else(|| at("`Ns` has a number"))?.clamp(1.0, 1024.0),
            // Color and light, without highlights.
            "illum" if matches!(rest.trim(), "0" | "1") => (look.specular, has_gloss) = ([0.0; 3], false),
            "map_Kd" => look.texture = file(rest).map(TextureSource::File),
            _ => {}
        }
    }
    Ok(looks)
}

fn scalar(text: &str) -> Option<f64> {
    text.split_whitespace().next()?.parse().ok().filter(|value: &f64| value.is_finite())
}

/// One number is a gray. Colors of spectra are gray, too.
fn color(text: &str) -> Option<[f64; 3]> {
    if text.trim_start().starts_with(['s', 'x']) {
        return Some([0.7; 3]);
    }
    let numbers: Option<Vec<f64>> = text.split_whitespace().take(3).map(|word| word.parse().ok()).collect();
    let numbers = numbers.filter(|list| list.iter().all(|value| value.is_finite()))?;
    match numbers.as_slice() {
        [gray] => Some([*gray; 3]),
        [r, g, b] => Some([*r, *g, *b]),
        _ => None,
    }
}

/// The file after the options; its name may have spaces.
fn file(text: &str) -> Option<String> {
    let mut rest = text.trim();
    while let Some((_, most)) = OPTIONS.iter().find(|(name, _)| rest.split_whitespace().next() == Some(name)) {
        rest = after_word(rest);
        for taken in 0..*most {
            let is_number = rest.split_whitespace().next().is_some_and(|word| word.parse::<f64>().is_ok());
            if taken > 0 && !is_number {
                break;
            }
            rest = after_word(rest);
        }
    }
    (!rest.is_empty()).then(|| rest.replace('\\', "/"))
}

fn after_word(text: &str) -> &str {
    text.split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_have_their_colors_and_their_picture() {
        let looks = parse(
            "# made by hand\nnewmtl red wood\nKa 1 1 1\nKd 0.8 0.1 0.1\nKs 0.5\nNs 96.078431\nKe 0 0 0.5\nillum 2\n\
             map_Kd -s 2 2 1 -clamp on textures\\my wood.png\n\nnewmtl matte\nKd 0.2 0.3 0.4\nKs 1 1 1\nillum 1\n",
        );
        let looks = looks.expect("it is right");
        assert_eq!(looks.len(), 2);
        assert_eq!(
            (looks[0].name.as_str(), looks[0].diffuse, looks[0].specular),
            ("red wood", [0.8, 0.1, 0.1], [0.5; 3])
        );
        assert_eq!((looks[0].emission, looks[0].shininess), ([0.0, 0.0, 0.5], 96.078431));
        assert_eq!(looks[0].texture, Some(TextureSource::File("textures/my wood.png".to_owned())));
        assert_eq!((looks[1].specular, looks[1].texture.is_none()), ([0.0; 3], true));
    }

    #[test]
    fn mistakes_name_their_line() {
        assert_eq!(parse("newmtl a\nKd 0.1 red 0"), Err("line 2: `Kd` has one or three numbers".to_owned()));
        assert_eq!(parse("newmtl a\n\nNs"), Err("line 3: `Ns` has a number".to_owned()));
        assert_eq!(parse("Kd what"), Ok(Vec::new()));
    }
}

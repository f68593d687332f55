//! Parses meshes in Wavefront's OBJ format: `v`, `vt`, `vn`, `f`. Polygons become fans; everything else is ignored.

use super::Geometry;
use std::collections::BTreeMap;

/// A corner of a face with its indices in the file: position, texture coordinate, normal.
type Corner = (usize, Option<usize>, Option<usize>);

/// Parses a mesh.
///
/// # Errors
/// A sentence that names the line.
pub(super) fn parse(text: &str) -> Result<Geometry, String> {
    let mut positions: Vec<[f64; 3]> = Vec::new();
    let mut normals: Vec<[f64; 3]> = Vec::new();
    let mut texcoords: Vec<[f64; 2]> = Vec::new();
    let mut vertices: BTreeMap<Corner, u32> = BTreeMap::new();
    let mut geometry = Geometry::default();
    for (number, line) in text.lines().enumerate() {
        let at = |what: &str| format!("line {}: {what}", number + 1);
        let mut words = line.split('#').next().unwrap_or("").split_whitespace();
        match words.next() {
            Some("v") => positions.push(numbers(words).ok_or_else(|| at("a position has three numbers"))?),
            Some("vn") => normals.push(numbers(words).ok_or_else(|| at("a normal has three numbers"))?),
            Some("vt") => texcoords.push(numbers(words).ok_or_else(|| at("a texture coordinate has two numbers"))?),
            Some("f") => {
                let mut fan = Vec::new();
                for word in words {
                    let corner = parse_corner(word, (positions.len(), texcoords.len(), normals.len()))
                        .ok_or_else(|| at(&format!("`{word}` names no vertex")))?;
                    let next = vertices.len() as u32;
                    let index = *vertices.entry(corner).or_insert(next);
                    if index == next {
                        push_vertex(&mut geometry, corner, &positions, &texcoords, &normals);
                    }
                    fan.push(index);
                }
                if fan.len() < 3 {
                    return Err(at("a face has at least three corners"));
                }
                for pair in fan.windows(2).skip(1) {
                    geometry.indices.extend([fan.first(), pair.first(), pair.last()].into_iter().flatten());
                }
            }
            _ => {}
        }
    }
    if geometry.indices.is_empty() {
        return Err("it has no faces".into());
    }
    Ok(geometry)
}

fn numbers<'a, const N: usize>(words: impl Iterator<Item = &'a str>) -> Option<[f64; N]> {
    let list: Option<Vec<f64>> = words.take(N).map(|word| word.parse().ok()).collect();
    list?.try_into().ok()
}

/// `7`, `7/2`, `7//3`, `7/2/3`; negative numbers count from the end.
fn parse_corner(word: &str, counts: (usize, usize, usize)) -> Option<Corner> {
    let mut parts = word.split('/');
    let position = parse_index(parts.next()?, counts.0)?;
    let mut optional = |count| match parts.next() {
        None | Some("") => Some(None),
        Some(text) => parse_index(text, count).map(Some),
    };
    Some((position, optional(counts.1)?, optional(counts.2)?))
}

fn parse_index(text: &str, count: usize) -> Option<usize> {
    let number: i64 = text.parse().ok()?;
    let index = if number < 0 { i64::try_from(count).ok()? + number } else { number - 1 };
    usize::try_from(index).ok().filter(|&index| index < count)
}

fn push_vertex(
    geometry: &mut Geometry,
    (position, texcoord, normal): Corner,
    positions: &[[f64; 3]],
    texcoords: &[[f64; 2]],
    normals: &[[f64; 3]],
) {
    geometry.positions.extend(positions.get(position));
    geometry.texcoords.extend(texcoord.and_then(|index| texcoords.get(index)));
    geometry.normals.extend(normal.and_then(|index| normals.get(index)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_become_fans_and_corners_are_shared() {
        let mesh = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n").expect("a square");
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.normals.len(), 4);
        assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn mistakes_name_their_line() {
        assert_eq!(parse("v 0 0 0\nf 1 2 3"), Err("line 2: `2` names no vertex".into()));
        assert_eq!(parse("v 0 zero 0"), Err("line 1: a position has three numbers".into()));
        assert_eq!(parse(""), Err("it has no faces".into()));
    }
}

//! Parses meshes in Wavefront's OBJ format: `v`, `vt`, `vn`, `f`, `usemtl`, `mtllib`.
//!
//! *In:* text. *Out:* a [`Model`] with a part for each material. *Holds:* polygons of any number of corners become triangles;
//! negative indices count from the end; groups and objects are one mesh; lines, points, curves and everything else is
//! ignored.

use super::model::{Look, Model, Part};
use super::soup::{Corner, Soup};
use super::{MAX_TRIANGLES, polygon};
use glam::DVec3;

/// The lists of a file, and its faces by material.
#[derive(Default)]
struct Obj {
    lists: Soup,
    /// A color, or none, for each position.
    colors: Vec<Option<[f64; 3]>>,
    names: Vec<String>,
    faces: Vec<Vec<[Corner; 3]>>,
    current: Option<usize>,
    libraries: Vec<String>,
    n_triangles: usize,
}

/// Parses a mesh.
///
/// # Errors
/// A sentence that names the line.
pub(super) fn parse(text: &str) -> Result<Model, String> {
    let mut obj = Obj::default();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        // A backslash continues a line.
        let mut joined = String::new();
        let mut rest = line;
        while let Some(start) = rest.trim_end().strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            rest = lines.next().map_or("", |(_, next)| next);
        }
        let whole = if joined.is_empty() {
            line
        } else {
            joined.push_str(rest);
            &joined
        };
        obj.statement(whole).map_err(|error| format!("line {}: {error}", number + 1))?;
    }
    obj.model()
}

impl Obj {
    fn statement(&mut self, line: &str) -> Result<(), String> {
        let line = line.split('#').next().unwrap_or("").trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match word {
            "v" => self.position(rest),
            "vn" => {
                let [x, y, z] = numbers(rest).ok_or("a normal has three numbers")?;
                self.lists.normals.push([x, y, z]);
                Ok(())
            }
            "vt" => {
                let list = list(rest).filter(|list| !list.is_empty());
                let list = list.ok_or("a texture coordinate has two numbers")?;
                let at = |index: usize| list.get(index).copied().unwrap_or(0.0);
                self.lists.texcoords.push([at(0), at(1)]);
                Ok(())
            }
            "f" | "fo" => self.face(rest),
            "usemtl" => {
                self.current = Some(self.look(rest.trim()));
                Ok(())
            }
            "mtllib" => {
                self.libraries.push(rest.trim().to_owned());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// `v x y z`, with a weight or a color after it.
    fn position(&mut self, rest: &str) -> Result<(), String> {
        let list = list(rest).unwrap_or_default();
        let [x, y, z, more @ ..] = list.as_slice() else { return Err("a position has three numbers".into()) };
        self.lists.positions.push([*x, *y, *z]);
        self.colors.push(match more {
            [r, g, b] | [_, r, g, b] | [r, g, b, _, _] => Some([*r, *g, *b]),
            _ => None,
        });
        Ok(())
    }

    fn look(&mut self, name: &str) -> usize {
        let known = self.names.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.faces.push(Vec::new());
            self.names.len() - 1
        })
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let corners = rest.split_whitespace().map(|word| self.corner(word)).collect::<Result<Vec<Corner>, String>>()?;
        if corners.len() < 3 {
            return Err("a face has at least three corners".into());
        }
        let points: Vec<DVec3> = corners.iter().map(|corner| self.lists.position(*corner)).collect();
        let triangles = polygon::triangles(&points);
        self.n_triangles += triangles.len();
        if self.n_triangles > MAX_TRIANGLES {
            return Err(format!("more than {MAX_TRIANGLES} triangles, the most that a mesh has"));
        }
        let look = match self.current {
            Some(look) => look,
            None => self.look(""),
        };
        if let Some(faces) = self.faces.get_mut(look) {
            let corner = |index: usize| corners.get(index).copied();
            faces.extend(triangles.into_iter().filter_map(|[a, b, c]| Some([corner(a)?, corner(b)?, corner(c)?])));
        }
        Ok(())
    }

    /// `7`, `7/2`, `7//3`, `7/2/3`; negative numbers count from the end.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut parts = word.split('/');
        let lists = &self.lists;
        let rows = [
            ("position", "v", lists.positions.len()),
            ("texture coordinate", "vt", lists.texcoords.len()),
            ("normal", "vn", lists.normals.len()),
        ];
        let mut found = [None; 3];
        for ((what, key, count), found) in rows.into_iter().zip(&mut found) {
            *found = match parts.next() {
                None | Some("") => None,
                // Exporters write it for none.
                Some("0") if what != "position" => None,
                Some(text) => Some(index(text, count).ok_or_else(|| match text.parse::<i64>() {
                    Ok(0) => format!("`{word}`: indices begin with 1"),
                    Ok(_) => format!("`{word}` names {what} {text}, and the lines before have {count} `{key}`"),
                    Err(_) => format!("`{word}` is no corner of a face: `7`, `7/2`, `7//3` or `7/2/3` is"),
                })?),
            };
        }
        let [Some(position), texcoord, normal] = found else { return Err(format!("`{word}` names no position")) };
        if parts.next().is_some() {
            return Err(format!("`{word}` has more than three indices"));
        }
        Ok(Corner { position, texcoord, normal })
    }

    fn model(self) -> Result<Model, String> {
        if self.n_triangles == 0 {
            return Err(match self.lists.positions.len() {
                0 => "it has no faces (lines `f`), nor positions (lines `v`): is it Wavefront's OBJ?".to_owned(),
                n => format!("it has {n} positions and no faces (lines `f`)"),
            });
        }
        let colors: Option<Vec<[f64; 4]>> =
            self.colors.iter().map(|color| color.map(|[r, g, b]| [r, g, b, 1.0])).collect();
        let lists = Soup { colors: colors.unwrap_or_default(), ..self.lists };
        let looks: Vec<Look> = self.names.iter().map(|name| Look::plain(name)).collect();
        let used = self.faces.into_iter().enumerate().filter(|(_, triangles)| !triangles.is_empty());
        let parts = used.map(|(look, triangles)| Part { look, soup: part(&lists, triangles) }).collect();
        Ok(Model { parts, looks, libraries: self.libraries, ..Model::default() })
    }
}

/// The triangles of a material with only the positions that they use, so that many materials do not copy all of them.
fn part(lists: &Soup, triangles: Vec<[Corner; 3]>) -> Soup {
    let mut rows: Vec<u32> = triangles.iter().flatten().map(|corner| corner.position).collect();
    rows.sort_unstable();
    rows.dedup();
    let new = |position: u32| rows.binary_search(&position).map_or(0, |row| row as u32);
    let of = |list: &[[f64; 4]]| rows.iter().filter_map(|row| list.get(*row as usize).copied()).collect();
    let mut texcoords = Renumbered::default();
    let mut normals = Renumbered::default();
    let triangles = triangles
        .iter()
        .map(|triangle| {
            triangle.map(|corner| Corner {
                position: new(corner.position),
                texcoord: corner.texcoord.map(|row| texcoords.of(row)),
                normal: corner.normal.map(|row| normals.of(row)),
            })
        })
        .collect();
    Soup {
        positions: rows.iter().filter_map(|row| lists.positions.get(*row as usize).copied()).collect(),
        colors: of(&lists.colors),
        tangents: Vec::new(),
        texcoords2: Vec::new(),
        texcoords: texcoords.old.iter().filter_map(|row| lists.texcoords.get(*row as usize).copied()).collect(),
        normals: normals.old.iter().filter_map(|row| lists.normals.get(*row as usize).copied()).collect(),
        triangles,
    }
}

/// Rows of a list, numbered in the order of their use.
#[derive(Default)]
struct Renumbered {
    old: Vec<u32>,
    new: std::collections::HashMap<u32, u32>,
}

impl Renumbered {
    fn of(&mut self, row: u32) -> u32 {
        let next = self.old.len() as u32;
        let new = *self.new.entry(row).or_insert(next);
        if new == next {
            self.old.push(row);
        }
        new
    }
}

/// All numbers of a line, if they are finite as f32.
fn list(text: &str) -> Option<Vec<f64>> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|value| (*value as f32).is_finite());
    text.split_whitespace().map(number).collect()
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    list(text)?.get(..N)?.try_into().ok()
}

fn index(text: &str, count: usize) -> Option<u32> {
    let number: i64 = text.parse().ok()?;
    let index = if number < 0 { i64::try_from(count).ok()?.checked_add(number)? } else { number - 1 };
    let index = usize::try_from(index).ok().filter(|&index| index < count)?;
    u32::try_from(index).ok()
}

#[cfg(test)]
mod tests {
    use super::super::Normals;
    use super::*;

    fn error(text: &str) -> String {
        parse(text).expect_err("it is wrong")
    }

    #[test]
    fn polygons_become_triangles_and_corners_are_shared() {
        let model = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n").expect("a square");
        let mesh = model.geometry(None, Normals::of_file()).geometry;
        assert_eq!((mesh.positions.len(), mesh.normals.len()), (4, 4));
        assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
        assert_eq!(mesh.texcoords, [[0.0; 2]; 4]);
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, message) in [
            ("v 0 0 0\nf 1 2 3", "line 2: `2` names position 2, and the lines before have 1 `v`"),
            ("v 0 zero 0", "line 1: a position has three numbers"),
            ("v 0 nan 0", "line 1: a position has three numbers"),
            ("v 0 1e300 0", "line 1: a position has three numbers"),
            ("v 0 0 0\nv 1 0 0\nf 1 2", "line 3: a face has at least three corners"),
            ("v 0 0 0\nf 0 1 1", "line 2: `0`: indices begin with 1"),
            ("v 0 0 0\nf 1/0/1 1 1", "line 2: `1/0/1` names normal 1, and the lines before have 0 `vn`"),
            ("v 0 0 0\nf 1/2 1 1", "line 2: `1/2` names texture coordinate 2, and the lines before have 0 `vt`"),
            ("v 0 0 0\nf a b c", "line 2: `a` is no corner of a face: `7`, `7/2`, `7//3` or `7/2/3` is"),
            ("v 0 0 0\nf 1/// 1 1", "line 2: `1///` has more than three indices"),
            ("v 0 0 0\nf -2 1 1", "line 2: `-2` names position -2, and the lines before have 1 `v`"),
            ("v 0 0 0", "it has 1 positions and no faces (lines `f`)"),
            ("", "it has no faces (lines `f`), nor positions (lines `v`): is it Wavefront's OBJ?"),
        ] {
            assert_eq!(error(text), message);
        }
    }

    #[test]
    fn a_line_goes_on_after_a_backslash_and_colors_follow_positions() {
        let model = parse("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nf 1 \\\n 2 3\n").expect("a triangle");
        let mesh = model.geometry(None, Normals::of_file()).geometry;
        assert_eq!(mesh.colors, [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
        assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    }
}

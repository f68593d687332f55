//! Profiles of lamps: IES LM-63 files, as makers of lamps publish them.
//!
//! *In:* the bytes of a file. *Out:* a [`Profile`]: candela by the angle from the lamp's axis. *Holds:* every number is finite and in
//! the range that the standard gives it; whatever else is in the file is an error with its line. *Not done here:* tilted lamps, and
//! lamps that are not round.

/// The largest file, in bytes.
const MAX_BYTES: usize = 1 << 20;
/// The largest number of angles in a plane, and of planes.
const MAX_ANGLES: usize = 4096;
const MAX_PLANES: usize = 721;
/// The largest candela, lumen and factor.
const MAX_NUMBER: f64 = 1e9;
/// The smallest step from an angle to the next, in degrees.
const LEAST_STEP: f64 = 1e-6;

/// The light of a round lamp.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The angles from the axis in degrees, growing, and the candela there.
    points: Vec<(f64, f64)>,
}

/// The words of a file with the numbers of their lines.
struct Words<'t> {
    words: Vec<(usize, &'t str)>,
    next: usize,
    last_line: usize,
}

/// The numbers in front of the angles.
struct Head {
    factor: f64,
    n_vertical: usize,
    n_horizontal: usize,
}

impl Profile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it, and its line.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() > MAX_BYTES {
            return Err(format!("it has more than {MAX_BYTES} bytes"));
        }
        // Names in the header may be in any encoding.
        let text = String::from_utf8_lossy(bytes);
        let mut words = Words::after_tilt(&text)?;
        let mut head = Head::read(&mut words)?;
        head.factor *= words.number("the ballast factor", 0.0, MAX_NUMBER)?;
        words.number("the factor after the ballast's", 0.0, MAX_NUMBER)?;
        words.number("the power in watts", 0.0, MAX_NUMBER)?;
        let angles = vertical(&mut words, head.n_vertical)?;
        horizontal(&mut words, head.n_horizontal)?;
        let planes = (0..head.n_horizontal).map(|_| words.numbers("candela", head.n_vertical, 0.0, MAX_NUMBER));
        let planes = planes.collect::<Result<Vec<_>, _>>()?;
        words.end()?;
        let first = round(planes)?;
        Ok(Self { points: angles.into_iter().zip(first.into_iter().map(|candela| candela * head.factor)).collect() })
    }

    /// The candela at an angle from the axis in degrees: linear between those of the file, 0 outside of them.
    pub fn candela(&self, angle: f64) -> f64 {
        let after = self.points.partition_point(|(known, _)| *known <= angle);
        let Some((a, below)) = after.checked_sub(1).and_then(|at| self.points.get(at)) else { return 0.0 };
        match self.points.get(after) {
            Some((b, above)) => below + (angle - a) / (b - a) * (above - below),
            None if angle == *a => *below,
            None => 0.0,
        }
    }

    /// All the light in lumen: the integral of the candela over all directions, exact for candela that are linear between the angles.
    pub fn lumen(&self) -> f64 {
        let zones = self.points.windows(2).filter_map(|pair| Some((pair.first()?, pair.get(1)?)));
        zones.map(|((a, below), (b, above))| zone((a.to_radians(), *below), (b.to_radians(), *above))).sum()
    }
}

/// The lumen between two angles: the integral of 2 pi (c + s (x - a)) sin x.
fn zone((a, below): (f64, f64), (b, above): (f64, f64)) -> f64 {
    let slope = (above - below) / (b - a);
    let cosines = below * a.cos() - above * b.cos();
    std::f64::consts::TAU * (cosines + slope * (b.sin() - a.sin()))
}

impl<'t> Words<'t> {
    /// The words after the line with `TILT=`.
    fn after_tilt(text: &'t str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
        let tilt = lines.find_map(|(line, text)| Some((line, text.strip_prefix("TILT=")?.trim())));
        match tilt {
            None => return Err("it has no line with `TILT=`, so it is no IES file".into()),
            Some((_, "NONE")) => {}
            Some((line, _)) => {
                return Err(format!("line {line}: a lamp whose light depends on its tilt; only `TILT=NONE` is read"));
            }
        }
        let split = |(line, text): (usize, &'t str)| {
            let words = text.split(|letter: char| letter.is_whitespace() || letter == ',');
            words.filter(|word| !word.is_empty()).map(move |word| (line, word))
        };
        let words = lines.flat_map(split).collect();
        Ok(Self { words, next: 0, last_line: text.lines().count() })
    }

    fn number(&mut self, what: &str, least: f64, most: f64) -> Result<f64, String> {
        let Some((line, word)) = self.words.get(self.next) else {
            return Err(format!("line {}: the file ends where {what} should be", self.last_line));
        };
        self.next += 1;
        let number: f64 = word.parse().map_err(|_| format!("line {line}: `{}` is not a number", shown(word)))?;
        if (least..=most).contains(&number) {
            return Ok(number);
        }
        Err(format!("line {line}: {what} is {least} to {most}, not `{}`", shown(word)))
    }

    fn whole(&mut self, what: &str, least: usize, most: usize) -> Result<usize, String> {
        let line = self.line();
        let number = self.number(what, least as f64, most as f64)?;
        if number.fract() == 0.0 { Ok(number as usize) } else { Err(format!("line {line}: {what} is a whole number")) }
    }

    fn numbers(&mut self, what: &str, count: usize, least: f64, most: f64) -> Result<Vec<f64>, String> {
        (0..count).map(|_| self.number(what, least, most)).collect()
    }

    /// The line of the next word.
    fn line(&self) -> usize {
        self.words.get(self.next).map_or(self.last_line, |(line, _)| *line)
    }

    fn end(&self) -> Result<(), String> {
        match self.words.get(self.next) {
            Some((line, word)) => Err(format!("line {line}: `{}` comes after the last candela", shown(word))),
            None => Ok(()),
        }
    }
}

/// The start of a word, for messages.
fn shown(word: &str) -> String {
    word.chars().take(24).collect()
}

impl Head {
    fn read(words: &mut Words<'_>) -> Result<Self, String> {
        words.number("the number of lamps", 1.0, 1e6)?;
        // -1 for measured candela, which are not per lumen.
        words.number("the lumen of a lamp", -1.0, MAX_NUMBER)?;
        let factor = words.number("the factor of the candela", 0.0, MAX_NUMBER)?;
        let n_vertical = words.whole("the number of vertical angles", 2, MAX_ANGLES)?;
        let n_horizontal = words.whole("the number of horizontal angles", 1, MAX_PLANES)?;
        let line = words.line();
        if words.whole("the type of photometry", 1, 3)? != 1 {
            return Err(format!(
                "line {line}: only photometry of type C (1) is read, whose vertical angle is from the lamp's axis"
            ));
        }
        words.whole("the unit of length", 1, 2)?;
        // A negative size says that the lamp is round.
        words.numbers("a size of the lamp", 3, -1e4, 1e4)?;
        Ok(Self { factor, n_vertical, n_horizontal })
    }
}

fn vertical(words: &mut Words<'_>, count: usize) -> Result<Vec<f64>, String> {
    let line = words.line();
    let angles = words.numbers("a vertical angle", count, 0.0, 180.0)?;
    match is_growing(&angles) {
        true => Ok(angles),
        false => Err(format!("line {line}: vertical angles grow from each to the next")),
    }
}

fn horizontal(words: &mut Words<'_>, count: usize) -> Result<(), String> {
    let line = words.line();
    let angles = words.numbers("a horizontal angle", count, 0.0, 360.0)?;
    if is_growing(&angles) { Ok(()) } else { Err(format!("line {line}: horizontal angles grow from each to the next")) }
}

fn is_growing(angles: &[f64]) -> bool {
    angles.iter().zip(angles.iter().skip(1)).all(|(a, b)| b - a >= LEAST_STEP)
}

/// The one plane, or the first of planes that are equal.
fn round(planes: Vec<Vec<f64>>) -> Result<Vec<f64>, String> {
    let n_planes = planes.len();
    let mut planes = planes.into_iter();
    let first = planes.next().unwrap_or_default();
    match planes.position(|plane| plane != first) {
        None => Ok(first),
        Some(at) => {
            Err(format!("its plane {} of {n_planes} differs from the first: only round lamps are read", at + 2))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] glisten\nTILT=NONE\n1 1000 2.0 3 1 1 2 0 0 0\n0.5 1.0 20\n\
                        0 45 90\n0\n300 200.5 0\n";

    fn error(text: &str) -> String {
        Profile::parse(text.as_bytes()).expect_err("it is broken")
    }

    #[test]
    fn candela_are_linear_between_the_angles_and_nothing_is_outside() {
        let profile = Profile::parse(GOOD.as_bytes()).expect("it is good");
        let found = [0.0, 22.5, 45.0, 67.5, 90.0, 90.1, 180.0, -1.0].map(|angle| profile.candela(angle));
        assert_eq!(found, [300.0, 250.25, 200.5, 100.25, 0.0, 0.0, 0.0, 0.0]);
    }

    /// A lamp that shines evenly has 4 pi times its candela; one of the file above by the trapezoids of a fine sum.
    #[test]
    fn lumen_are_the_integral_of_candela() {
        let even = GOOD.replace("0 45 90\n", "0 90 180\n").replace("300 200.5 0", "1 1 1");
        let lumen = Profile::parse(even.as_bytes()).expect("it is good").lumen();
        assert!((lumen - 4.0 * std::f64::consts::PI).abs() < 1e-12, "{lumen}");
        let profile = Profile::parse(GOOD.as_bytes()).expect("it is good");
        let step = |at: i32| (f64::from(at) + 0.5) * 90.0 / 1e5;
        let part = |at: i32| profile.candela(step(at)) * step(at).to_radians().sin() * (90.0_f64 / 1e5).to_radians();
        let sum = std::f64::consts::TAU * (0..100_000).map(part).sum::<f64>();
        assert!((profile.lumen() / sum - 1.0).abs() < 1e-6, "{} for {sum}", profile.lumen());
    }

    #[test]
    fn numbers_may_be_on_any_lines_and_equal_planes_are_round() {
        let text =
            "TILT=NONE\r\n1\r\n1000,2.0 3\r\n2 1 2 0 0 0 0.5\r\n1.0 20 0 45 90 0\r\n90 300 200.5\r\n0 300 200.5 0";
        assert_eq!(Profile::parse(text.as_bytes()), Profile::parse(GOOD.as_bytes()));
    }

    #[test]
    fn each_error_has_its_line() {
        for (from, to, expected) in [
            ("TILT=NONE", "", "it has no line with `TILT=`"),
            ("TILT=NONE", "TILT=INCLUDE", "line 4: a lamp whose light depends on its tilt"),
            ("2.0 3 1", "x 3 1", "line 5: `x` is not a number"),
            ("2.0 3 1", "nan 3 1", "line 5: the factor of the candela is 0 to"),
            ("2.0 3 1", "inf 3 1", "line 5: the factor of the candela is 0 to"),
            ("2.0 3 1", "2.0 1e9 1", "line 5: the number of vertical angles is 2 to 4096"),
            ("2.0 3 1", "2.0 2.5 1", "line 5: the number of vertical angles is a whole number"),
            ("3 1 1 2", "3 1 2 2", "line 5: only photometry of type C"),
            ("0 45 90", "0 45 45", "line 7: vertical angles grow"),
            ("0 45 90", "0 45 190", "line 7: a vertical angle is 0 to 180"),
            ("300 200.5 0", "300 -1 0", "line 9: candela is 0 to"),
            ("300 200.5 0", "300 200.5", "line 9: the file ends where candela should be"),
            ("300 200.5 0", "300 200.5 0 7", "line 9: `7` comes after the last candela"),
            ("3 1 1 2", "3 2 1 2", "line 9: the file ends where candela should be"),
        ] {
            let broken = GOOD.replace(from, to);
            assert!(error(&broken).starts_with(expected), "{from} -> {to}: {}", error(&broken));
        }
        let planes =
            GOOD.replace("3 1 1 2", "3 2 1 2").replace("\n0\n", "\n0 90\n").replace("200.5 0", "200.5 0 300 200 0");
        assert_eq!(error(&planes), "its plane 2 of 2 differs from the first: only round lamps are read");
        assert!(error(&" ".repeat(MAX_BYTES + 1)).contains("bytes"));
    }

    /// Every file that is a part of a good one, and every one with a byte changed, is read or refused.
    #[test]
    fn no_broken_file_panics() {
        for end in 0..GOOD.len() {
            let _ = Profile::parse(&GOOD.as_bytes()[..end]);
            for byte in [0, b'-', b'9', b'e', 0xff] {
                let mut broken = GOOD.as_bytes().to_vec();
                broken[end] = byte;
                if let Ok(profile) = Profile::parse(&broken) {
                    assert!((0..=180).all(|angle| profile.candela(f64::from(angle)).is_finite()));
                }
            }
        }
    }
}

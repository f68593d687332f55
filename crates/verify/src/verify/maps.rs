//! Pictures of a verification: where the differences are ([`difference`]), and what was judged ([`evidence`]).
//!
//! *In:* the reference's picture, and a number or a class for each pixel. *Out:* pictures of the same size.

use glisten_scene::compare::Class;
use glisten_scene::picture::Picture;

/// The meaning of the colors of a [difference](super::Verification::difference).
pub const DIFFERENCE_LEGEND: &str = "black: equal; to bright blue: up to the bound; yellow to red: up to and beyond ten \
                                     times the bound; magenta: covered or finite on one side alone";

/// The picture of `shares` ([`shares`](glisten_scene::compare::shares)) in the size of the reference's, by the colors of
/// [`DIFFERENCE_LEGEND`].
pub fn difference(reference: &Picture, shares: &[f64]) -> Picture {
    Picture::of_colors(reference.width, reference.height, shares.iter().map(|share| share_color(*share)).collect())
}

/// The color of a difference relative to its bound. Within the bound, all colors are calm ones.
fn share_color(share: f64) -> [f64; 4] {
    let mix = |from: [f64; 3], to: [f64; 3], x: f64| {
        let [r, g, b] = std::array::from_fn(|i| from[i] * (1.0 - x) + to[i] * x);
        [r, g, b, 1.0]
    };
    match share {
        _ if !share.is_finite() => [1.0, 0.0, 1.0, 1.0],
        _ if share > 1.0 => mix([1.0, 0.9, 0.2], [1.0, 0.0, 0.0], share.log10().min(1.0)),
        _ => mix([0.0; 3], [0.25, 0.55, 1.0], share.max(0.0)),
    }
}

/// The meaning of the colors of an [evidence picture](super::Verification::evidence).
pub const EVIDENCE_LEGEND: &str = "green: judged; light green: likely; blue: at an edge; yellow: weak; red: unlimited; \
                                   magenta: undecided; white: undefined; gray: excused; black: not covered";

/// The picture of the classes of pixels in the size of the reference's, by the colors of [`EVIDENCE_LEGEND`].
pub fn evidence(reference: &Picture, classes: &[Option<Class>]) -> Picture {
    Picture::of_colors(reference.width, reference.height, classes.iter().map(|class| class_color(*class)).collect())
}

fn class_color(class: Option<Class>) -> [f64; 4] {
    let [r, g, b] = match class {
        None => [0.0, 0.0, 0.0],
        Some(Class::Judged) => [0.1, 0.6, 0.2],
        Some(Class::Edge) => [0.2, 0.4, 1.0],
        Some(Class::Weak) => [1.0, 0.85, 0.1],
        Some(Class::Unlimited) => [0.9, 0.1, 0.1],
        Some(Class::Undecided) => [0.85, 0.1, 0.85],
        Some(Class::Excused) => [0.6, 0.6, 0.6],
        Some(Class::Likely) => [0.6, 0.9, 0.4],
        Some(Class::Undefined) => [1.0, 1.0, 1.0],
    };
    [r, g, b, 1.0]
}

/// For each pixel, the class of two that says less.
pub(super) fn worse_classes(classes: &mut Vec<Option<Class>>, other: Vec<Option<Class>>) {
    if classes.is_empty() {
        *classes = other;
        return;
    }
    let order = |class: &Option<Class>| {
        class.map_or(0, |class| match class {
            Class::Judged => 1,
            Class::Edge => 2,
            Class::Likely => 3,
            Class::Excused => 4,
            Class::Weak => 5,
            Class::Undecided => 6,
            Class::Unlimited => 7,
            Class::Undefined => 8,
        })
    };
    for (class, other) in classes.iter_mut().zip(other) {
        if order(&other) > order(class) {
            *class = other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{class_color, difference, evidence, share_color, worse_classes};
    use glisten_scene::compare::Class;
    use glisten_scene::picture::Picture;

    /// Nothing within the bound is red, and nothing beyond it is blue.
    #[test]
    fn differences_are_calm_up_to_the_bound() {
        assert_eq!(share_color(0.0), [0.0, 0.0, 0.0, 1.0]);
        for step in 0..=100 {
            let [red, _, blue, _] = share_color(f64::from(step) / 100.0);
            assert!(blue >= red, "{step}");
            let [red, _, blue, _] = share_color(1.001 + f64::from(step));
            assert!(red > blue, "{step}");
        }
        assert_eq!(share_color(f64::INFINITY), share_color(f64::NAN));
        let reference = Picture::of_colors(2, 1, vec![[0.0; 4]; 2]);
        assert_eq!(difference(&reference, &[0.0, 99.0]).attachments[0], [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
    }

    #[test]
    fn every_class_has_a_color_of_its_own() {
        let mut colors: Vec<_> = Class::ALL.iter().map(|class| class_color(Some(*class)).map(f64::to_bits)).collect();
        colors.push(class_color(None).map(f64::to_bits));
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), Class::ALL.len() + 1);
        let reference = Picture::of_colors(2, 1, vec![[0.0; 4]; 2]);
        let picture = evidence(&reference, &[None, Some(Class::Weak)]);
        assert_eq!(picture.attachments[0], [class_color(None), class_color(Some(Class::Weak))]);
    }

    #[test]
    fn the_class_that_says_less_counts() {
        let mut classes = Vec::new();
        worse_classes(&mut classes, vec![None, Some(Class::Judged), Some(Class::Unlimited)]);
        worse_classes(&mut classes, vec![Some(Class::Edge), Some(Class::Weak), Some(Class::Judged)]);
        assert_eq!(classes, [Some(Class::Edge), Some(Class::Weak), Some(Class::Unlimited)]);
    }
}

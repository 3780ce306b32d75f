//! An analysed film with its name, and the walks in it.

use std::fmt::Write as _;

use lizard_film::AnalysedFilm;

/// An analysed film with its name.
#[derive(Debug, Clone)]
pub struct NamedFilm {
    /// The name in messages, such as the path of the file.
    pub name: String,
    /// The camera and the robot's path in the film.
    pub analysis: AnalysedFilm,
}

impl NamedFilm {
    /// The walks between rests of at least `min_rest` seconds. If there are none, the whole film counts as a walk, so
    /// that its measurement fails with a reason.
    pub(crate) fn walks(&self, min_rest: f64) -> Vec<Walk<'_>> {
        let mut walks = self.analysis.walks(min_rest);
        if walks.is_empty() {
            walks.extend(self.time_range());
        }
        let walk_of = |interval| Walk {
            film: self,
            interval,
        };
        walks.into_iter().map(walk_of).collect()
    }

    /// The times of the first and the last point of the path, s; `None` if it has fewer than two points.
    pub(crate) fn time_range(&self) -> Option<[f64; 2]> {
        match &self.analysis.path[..] {
            [first, .., last] => Some([first.seconds, last.seconds]),
            _ => None,
        }
    }

    /// The robot's path as CSV with the columns `seconds,forward,left,heading`, in mm and deg on the floor.
    pub fn path_csv(&self) -> String {
        let mut text = "seconds,forward,left,heading\n".to_owned();
        for point in &self.analysis.path {
            let place = point.place;
            let _ = writeln!(
                text,
                "{:.4},{:.3},{:.3},{:.3}",
                point.seconds,
                place.forward,
                place.left,
                place.heading.to_degrees()
            );
        }
        text
    }
}

/// A walk between two rests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Walk<'f> {
    pub film: &'f NamedFilm,
    /// Beginning and end in the film, s, which include a part of the rests.
    pub interval: [f64; 2],
}

impl Walk<'_> {
    /// The walk's label in messages: the film and the times.
    pub(crate) fn label(&self) -> String {
        let [from, to] = self.interval;
        format!("{}, {from:.1} to {to:.1} s", self.film.name)
    }
}

//! A film after evaluation, with its name, and the walks in it.

use std::fmt::Write as _;

use lizard_film::AnalysedFilm;

/// A film after evaluation, with its name.
#[derive(Debug, Clone)]
pub struct WatchedFilm {
    /// The name in messages, such as its path.
    pub name: String,
    /// The camera and the robot's path in the film.
    pub watched: AnalysedFilm,
}

impl WatchedFilm {
    /// The walks between rests of at least `rest` seconds. If there are none, the whole film counts as a
    /// walk, whose measurement then fails with a reason.
    pub(crate) fn walks(&self, rest: f64) -> Vec<Walk<'_>> {
        let mut walks = self.watched.walks(rest);
        if walks.is_empty() {
            walks.extend(self.time_range());
        }
        let walk_of = |during| Walk { film: self, during };
        walks.into_iter().map(walk_of).collect()
    }

    /// Times of the first and the last position of the robot, s; `None` if there are fewer than two
    /// positions.
    pub(crate) fn time_range(&self) -> Option<[f64; 2]> {
        match &self.watched.path[..] {
            [first, .., last] => Some([first.seconds, last.seconds]),
            _ => None,
        }
    }

    /// The robot's path as CSV: seconds,forward,left,heading; mm and degrees on the floor.
    pub fn path(&self) -> String {
        let mut text = "seconds,forward,left,heading\n".to_owned();
        for position in &self.watched.path {
            let place = position.place;
            let _ = writeln!(
                text,
                "{:.4},{:.3},{:.3},{:.3}",
                position.seconds,
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
    pub film: &'f WatchedFilm,
    /// Times in the film, s, with a part of the rests included.
    pub during: [f64; 2],
}

impl Walk<'_> {
    /// The walk's place in a message: the film and the times.
    pub(crate) fn label(&self) -> String {
        let [from, to] = self.during;
        format!("{}, {from:.1} to {to:.1} s", self.film.name)
    }
}

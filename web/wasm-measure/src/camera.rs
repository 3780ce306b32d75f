//! The film that the page takes, and the reports of the gaits in it.

use lizard_film::{Film, Picture, Setup, Tag, sheet};
use lizard_measure::{Gaits, Report, WatchedFilm, height_of_board};
use lizard_robot::Robot;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// A refusal: the reason as a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Tsify)]
pub struct Refused {
    /// The reason.
    pub refused: String,
}

impl Refused {
    pub(crate) fn of(reason: impl ToString) -> Self {
        Self {
            refused: reason.to_string(),
        }
    }
}

/// A tag in a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct TagEntry {
    /// Its id on the sheet.
    pub id: usize,
    /// Its corners, px: top left, top right, bottom right, bottom left, as it is printed.
    #[tsify(type = "[Pixel, Pixel, Pixel, Pixel]")]
    pub corners: [[f64; 2]; 4],
}

/// A request to measure gaits in the film.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct Asked {
    /// The robot.toml.
    pub toml: String,
    /// The pace, percent.
    pub speed: u8,
    /// Height of the deck's tag above the floor, mm; `None` for that of the board.
    pub height: Option<f64>,
    /// Measured length of the sheet's line that should be 100 mm long, mm.
    pub ruler: f64,
    /// The walks. If empty, the film is split at its rests, and each walk is assigned the gait that it clearly
    /// resembles.
    pub walks: Vec<AskedWalk>,
}

/// A gait that the robot walked in the film.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct AskedWalk {
    /// The gait's name.
    pub gait: String,
    /// Begin and end of the walk on the film's clock, s; `None` for the whole film.
    pub during: Option<[f64; 2]>,
}

/// The measured displacements of gaits.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct Results {
    /// The gaits as `lizard measure --json` writes them; walks of the same gait count together.
    #[tsify(type = "Report[]")]
    pub gaits: serde_json::Value,
    /// The reasons why walks cannot be measured, as sentences with their gaits.
    pub troubles: Vec<String>,
}

/// A film that is being taken.
#[derive(Debug, Default)]
pub struct Camera {
    film: Film,
    /// The path in the film with its setup; `None` if it must be computed again, since the film has a new picture.
    watched: Option<(Setup, WatchedFilm)>,
}

impl Camera {
    /// Finds the tags of a picture that is not added to the film.
    pub fn look(&mut self, picture: &Picture) -> Vec<TagEntry> {
        let tags = self.film.find_tags(picture).into_iter();
        tags.map(|Tag { id, corners }| TagEntry { id, corners })
            .collect()
    }

    /// Adds the next picture to the film, taken at this time, s, and finds its tags.
    ///
    /// # Errors
    /// Fails if the picture does not belong to the film, or shows a tag twice.
    pub fn add(&mut self, picture: &Picture, seconds: f64) -> Result<Vec<TagEntry>, Refused> {
        self.watched = None;
        let tags = self.film.add(seconds, picture).map_err(Refused::of)?;
        let entry_of = |(id, corners): (usize, &Option<_>)| {
            Some(TagEntry {
                id,
                corners: (*corners)?,
            })
        };
        Ok(tags.iter().enumerate().filter_map(entry_of).collect())
    }

    /// Measures gaits in the film.
    ///
    /// # Errors
    /// Fails if the robot.toml is invalid, the robot has no such gait, the film does not show what is needed, or a
    /// walk without a given gait does not clearly resemble one.
    pub fn measure(&mut self, request: &Asked) -> Result<Results, Refused> {
        let robot = Robot::parse(&request.toml).map_err(Refused::of)?;
        let gait_of = |walk: &AskedWalk| {
            let gait = robot.gait(&walk.gait).filter(|gait| gait.moves());
            gait.ok_or_else(|| Refused::of(format!("no gait `{}` moves this robot", walk.gait)))
        };
        let named_gaits: Vec<_> = request
            .walks
            .iter()
            .map(gait_of)
            .collect::<Result<_, _>>()?;
        let setup = Setup {
            scale: request.ruler / sheet::RULER,
            height: request.height.unwrap_or_else(|| height_of_board(&robot)),
        };
        let gaits = Gaits::new(&robot, &named_gaits, f64::from(request.speed) / 100.0);
        let film = match self.watched.take() {
            Some((watched_setup, film)) if watched_setup == setup => film,
            _ => WatchedFilm {
                name: "the film".to_owned(),
                watched: self.film.watch(setup).map_err(Refused::of)?,
            },
        };
        let (_, film) = self.watched.insert((setup, film));
        let films = std::slice::from_ref(&*film);
        let mut troubles = Vec::new();
        let walks = match request.walks.is_empty() {
            true => gaits.walks(films).map_err(Refused::of)?,
            false => {
                let measured_walks =
                    request
                        .walks
                        .iter()
                        .enumerate()
                        .filter_map(|(i, asked_walk)| {
                            let walk = gaits.walk(i, &films[0], asked_walk.during);
                            walk.map_err(|reason| {
                                troubles.push(format!("{}: {reason}", asked_walk.gait))
                            })
                            .ok()
                        });
                measured_walks.collect()
            }
        };
        let report = Report::new(&robot, request.speed, setup, films, &gaits, &walks);
        let report = report.with_ranges(&robot).with_mujoco(&request.toml);
        Ok(Results {
            gaits: serde_json::to_value(&report.gaits).map_err(Refused::of)?,
            troubles,
        })
    }
}

//! Notes that are written, and runs that are moved to the trash.
//!
//! A run that is thrown away is a folder below `.trash` of the
//! folder that is served: nothing is ever removed.

use super::asked::on_catalogue;
use crate::answer::{aside, json_of, refusal};
use crate::catalogue::Catalogue;
use crate::catalogue::files::is_held;
use crate::catalogue::notes::{FILE, TRASH, Words};
use crate::shared::Shared;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use hasard_media::files::write_whole;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Letters of a note, letters of a tag, tags.
const LONGEST_NOTE: usize = 4000;
const LONGEST_TAG: usize = 40;
const MOST_TAGS: usize = 20;

/// What is to become of a run.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Edit {
    id: String,
    note: Option<String>,
    tags: Option<Vec<String>>,
    archived: Option<bool>,
    /// The name of the run that is to be thrown away: asked for twice, so that no slip does it.
    throw_away: Option<String>,
}

impl Edit {
    /// The notes with what was changed.
    fn changed(self, mut words: Words) -> Result<Words, String> {
        if let Some(note) = self.note {
            if note.chars().count() > LONGEST_NOTE {
                return Err(format!("a note has at most {LONGEST_NOTE} letters"));
            }
            words.note = note;
        }
        if let Some(tags) = self.tags {
            let mut tags: Vec<String> = tags.iter().map(|tag| tag.trim().to_owned()).collect();
            tags.retain(|tag| !tag.is_empty());
            tags.sort();
            tags.dedup();
            if tags.len() > MOST_TAGS || tags.iter().any(|tag| tag.chars().count() > LONGEST_TAG) {
                let why = format!("a run has at most {MOST_TAGS} tags of {LONGEST_TAG} letters");
                return Err(why);
            }
            words.tags = tags;
        }
        words.archived = self.archived.unwrap_or(words.archived);
        Ok(words)
    }
}

/// Writes notes of a run, or throws it away.
pub(crate) async fn edit(
    State(shared): State<Arc<Shared>>,
    body: String,
) -> Result<Response, Response> {
    let edit: Edit = serde_json::from_str(&body)
        .map_err(|error| refusal(StatusCode::UNPROCESSABLE_ENTITY, &error.to_string()))?;
    let id = edit.id.clone();
    let place = on_catalogue(Arc::clone(&shared), move |catalogue| {
        catalogue.refresh();
        catalogue.place(&id)
    });
    let Some((path, name, top)) = place.await? else {
        let why = "there is no such run; choose one from the list of runs";
        return Err(refusal(StatusCode::NOT_FOUND, why));
    };
    let done = aside(move || match &edit.throw_away {
        Some(given) if *given == name => throw_away(&path, &name, &top),
        Some(_) => Err("give the name of the run to throw it away".to_owned()),
        None => {
            let file = path.join(FILE);
            let words = edit.changed(Words::of(&path, &name)?)?;
            let text = serde_json::to_string_pretty(&words).map_err(|error| error.to_string())?;
            write_whole(&file, text.as_bytes()).map_err(|error| error.to_string())?;
            Ok(json!({ "notes": words }))
        }
    });
    let done = done.await?.map_err(|why| refusal(StatusCode::UNPROCESSABLE_ENTITY, &why))?;
    on_catalogue(shared, Catalogue::look_again).await?;
    Ok(json_of(&done))
}

/// Moves a run to the trash.
fn throw_away(path: &Path, name: &str, top: &Path) -> Result<Value, String> {
    if path == top {
        return Err(format!(
            "{name} is the folder that is served; serve the one above it to throw it away"
        ));
    }
    if is_held(path) {
        return Err(format!("{name} is running; end its training first"));
    }
    let trash = top.join(TRASH);
    std::fs::create_dir_all(&trash).map_err(|error| format!("{}: {error}", trash.display()))?;
    let plain = name.replace(['/', '\\'], "_");
    let free = |number: u32| -> PathBuf {
        trash.join(if number == 1 { plain.clone() } else { format!("{plain}-{number}") })
    };
    let to = (1..10_000).map(free).find(|to| !to.exists()).ok_or("the trash is full")?;
    std::fs::rename(path, &to).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(json!({ "moved_to": to.display().to_string() }))
}

//! What a person meets on the pages beside the usual way: the skip link, wrong addresses, a full
//! house, other keys.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, serve, write_run};
use serde_json::json;

#[test]
fn the_skip_link_leads_into_the_page_and_names_of_objects_lead_nowhere() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("pages-skip");
    write_run(&folder, "one", 5);
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/#runs?text=one"));
    browser.wait("document.querySelectorAll('tbody tr').length == 1");
    browser.script("const skip = document.querySelector('a.skip'); skip.focus(); skip.click()");
    browser.wait("document.activeElement.id == 'page' && document.querySelector('tbody tr')");
    assert_eq!(browser.script("return location.hash"), json!("#runs?text=one"));
    for page in ["constructor", "toString", "__proto__", "nothing"] {
        browser.go(&format!("http://{address}/#{page}"));
        browser.wait("document.getElementById('page').innerText == 'There is no such page.'");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

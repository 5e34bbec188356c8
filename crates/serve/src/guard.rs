//! Who may ask. A page of another site that the user has open must not read or steer this server,
//! neither by a request across origins nor by a name that it lets point here (DNS rebinding).

use crate::answer::refusal;
use crate::shared::Shared;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::net::IpAddr;
use std::sync::Arc;

/// The cookie's name goes on with the port that the page was asked at: browsers send all cookies of
/// a host to each of its ports, and two servers of one name would log each other out.
const COOKIE: &str = "hasard-token";

/// Nothing is fetched from elsewhere, no script but ours runs, no other page frames this one.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; media-src 'self'; \
                      connect-src 'self' ws: wss:; form-action 'none'; base-uri 'none'; frame-ancestors 'none'";

/// Checks a request before any route sees it.
pub(crate) async fn guard(
    State(shared): State<Arc<Shared>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match allowed(&shared, &request) {
        Err(response) => *response,
        Ok(()) => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_FRAME_OPTIONS, "DENY"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    headers.insert("cross-origin-resource-policy", HeaderValue::from_static("same-origin"));
    if !headers.contains_key(header::CONTENT_SECURITY_POLICY) {
        headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    }
    response
}

fn allowed(shared: &Shared, request: &Request) -> Result<(), Box<Response>> {
    let no = |status, why: &str| Err(Box::new(refusal(status, why)));
    let headers = request.headers();
    let reads = request.method() == Method::GET || request.method() == Method::HEAD;
    let edits = request.method() == Method::POST && request.uri().path() == "/api/edit";
    if !(reads || edits && shared.edit) {
        let why = "this server is only read from; notes need: hasard serve --edit";
        return no(StatusCode::METHOD_NOT_ALLOWED, why);
    }
    // Browsers name the origin of all that is posted. A form of another site cannot send JSON.
    if edits
        && (text(headers, header::ORIGIN).is_none()
            || text(headers, header::CONTENT_TYPE) != Some("application/json"))
    {
        return no(StatusCode::FORBIDDEN, "what edits comes from the page, as JSON");
    }
    let host = text(headers, header::HOST);
    if !host.is_some_and(is_address) {
        return no(
            StatusCode::FORBIDDEN,
            "ask by address (http://127.0.0.1:8350) or as localhost: another name is not answered",
        );
    }
    // Browsers name the origin of every WebSocket and of every request across origins.
    if let Some(origin) = headers.get(header::ORIGIN) {
        let ours = origin
            .to_str()
            .ok()
            .and_then(|origin| origin.split_once("://"))
            .is_some_and(|(_, rest)| Some(rest) == host);
        if !ours {
            return no(StatusCode::FORBIDDEN, "this page belongs to another origin");
        }
    }
    if text(headers, header::HeaderName::from_static("sec-fetch-site"))
        .is_some_and(|site| site == "cross-site")
        && request.uri().path() != "/"
    {
        return no(StatusCode::FORBIDDEN, "another site asked for this");
    }
    let Some(token) = &shared.token else { return Ok(()) };
    let by_cookie = headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|line| line.to_str().ok())
        .flat_map(|line| line.split(';'));
    let name = format!("{COOKIE}-{}", port_of(host.unwrap_or_default()));
    let mut given =
        by_cookie.filter_map(|pair| pair.trim().strip_prefix(name.as_str())?.strip_prefix('='));
    if given.any(|given| equal(given, token)) {
        return Ok(());
    }
    let query = request.uri().query().unwrap_or_default();
    if query
        .split('&')
        .filter_map(|pair| pair.strip_prefix("token="))
        .any(|given| equal(given, token))
    {
        // The token goes out of the address and into a cookie, so that a copied link does not give
        // it away.
        let cookie = format!("{name}={token}; HttpOnly; SameSite=Strict; Path=/");
        let to = request.uri().path().to_owned();
        return Err(Box::new(
            (StatusCode::SEE_OTHER, [(header::SET_COOKIE, cookie), (header::LOCATION, to)])
                .into_response(),
        ));
    }
    no(
        StatusCode::UNAUTHORIZED,
        "this server wants its token: open the address that it printed when it began",
    )
}

fn text(headers: &HeaderMap, name: header::HeaderName) -> Option<&str> {
    let mut all = headers.get_all(name).iter();
    let first = all.next()?;
    if all.next().is_some() { None } else { first.to_str().ok() }
}

/// Whether a host is an address or localhost, with or without a port: no name that somebody else
/// can let point here.
fn is_address(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.parse::<u16>().is_ok() && !name.is_empty() => name,
        _ => host,
    };
    let bare = name.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(name);
    name == "localhost" || bare.parse::<IpAddr>().is_ok()
}

/// The port in a host that is an address; HTTP's own where it names none.
fn port_of(host: &str) -> u16 {
    host.rsplit_once(':').and_then(|(_, port)| port.parse().ok()).unwrap_or(80)
}

/// Compares in a time that does not show where the first difference is.
fn equal(given: &str, token: &str) -> bool {
    given.len() == token.len()
        && given.bytes().zip(token.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_are_addresses() {
        for good in ["127.0.0.1:8350", "localhost:8350", "localhost", "[::1]:80", "192.168.0.3"] {
            assert!(is_address(good), "{good}");
        }
        for bad in [
            "evil.example:8350",
            "127.0.0.1.evil.example",
            "localhost.evil.example",
            "",
            ":80",
            "localhost:99999999",
        ] {
            assert!(!is_address(bad), "{bad}");
        }
        for (host, port) in
            [("localhost:8350", 8350), ("localhost", 80), ("[::1]:81", 81), ("[::1]", 80)]
        {
            assert_eq!(port_of(host), port, "{host}");
        }
        assert!(equal("abc", "abc") && !equal("abd", "abc") && !equal("ab", "abc"));
    }
}

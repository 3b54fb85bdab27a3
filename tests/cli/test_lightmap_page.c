// The page of bake --lightmap in a real browser.
#include "cli/browser.h"
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1200, HEIGHT = 900 };

TEST(page_shows_checks_images_and_tables)
{
    char page[400];
    struct browser *browser = browser_open();
    setenv("AFTERGLOW_CACHE", make_folder("page-cache"), 1);
    run_expect(0, "bake @cornell --gi radiosity:texels=4096 --spp 8 --quiet --lightmap",
               path_of("page-maps"), NULL);
    snprintf(page, sizeof page, "%s", path_of("page-maps/report.html"));
    browser_load(browser, page, WIDTH, HEIGHT);
    CHECK_STRING(browser_complaints(browser), "");
    CHECK(browser_number(browser, "document.querySelectorAll('#check-table tbody tr').length") ==
          8);
    CHECK(browser_number(browser, "document.querySelectorAll('.images img').length") == 5);
    CHECK(browser_true(browser, "[...document.querySelectorAll('.images img')].every(image => "
                                "image.naturalWidth > 30 && image.complete)"));
    CHECK(browser_true(
        browser, "getComputedStyle(document.querySelector('img')).imageRendering === 'pixelated'"));
    CHECK(browser_number(browser, "document.querySelectorAll('#noise table tbody tr').length") ==
          10);
    CHECK(browser_number(browser, "document.querySelectorAll('#sizes .class').length") > 3);
    // No text of a value that is missing.
    CHECK(browser_true(browser, "!/NaN|undefined|null|Infinity/.test(document.body.innerText)"));
    // Nothing is wider than the window.
    CHECK(browser_true(browser, "document.documentElement.scrollWidth <= innerWidth"));
    // Overlaps are good, the noise of 8 paths is not.
    CHECK(browser_true(
        browser, "document.querySelector('#check-table tbody .state').textContent === 'good'"));
    CHECK(browser_true(browser, "[...document.querySelectorAll('#check-table tbody tr')].at(-1)"
                                ".querySelector('.state').textContent === 'look'"));
    const double narrow =
        browser_number(browser, "document.querySelector('.images img').clientWidth");
    browser_true(browser, "(document.querySelector('.images button').click(), true)");
    CHECK(browser_number(browser, "document.querySelector('.images img').clientWidth") > narrow);
    browser_dark(browser, true);
    CHECK(browser_true(browser, "getComputedStyle(document.body).backgroundColor !== "
                                "'rgb(252, 252, 252)'"));
    CHECK_STRING(browser_complaints(browser), "");
    // The number and places of several pages, and the page of each instance.
    run_expect(0, "bake @cornell --gi radiosity:texels=4096 --spp 8 --page 64 --quiet --lightmap",
               path_of("page-maps"), NULL);
    browser_load(browser, page, WIDTH, HEIGHT);
    CHECK(browser_true(browser,
                       "/^[2-9] pages/.test(document.querySelector('#facts dd').innerText)"));
    CHECK(browser_true(browser, "/0 at 0, 0; 1 at 64, 0/.test(document.body.innerText)"));
    CHECK(browser_true(browser, "/page [0-9]/.test(document.querySelector('#noise').innerText)"));
    CHECK(browser_true(browser, "!/NaN|undefined|null|Infinity/.test(document.body.innerText)"));
    CHECK(browser_true(browser, "document.documentElement.scrollWidth <= innerWidth"));
    browser_close(browser);
}

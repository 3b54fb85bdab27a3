// The JSON of reports.
#include "bake/report.h"

#include "framework/test.h"

#include <locale.h>
#include <math.h>

TEST(report_is_json_of_its_members)
{
    struct report *report = report_create(test_host());
    report_text_value(report, "technique", "a \"b\"\n\\");
    report_number(report, "seconds", 1.5);
    report_number(report, "none", (double)NAN);
    report_begin_list(report, "stages");
    for (int i = 0; i < 2; i++) {
        report_begin_object(report, NULL);
        report_number(report, "i", i);
        report_end(report);
    }
    report_end(report);
    report_begin_list(report, "empty");
    report_end(report);
    report_bool(report, "cached", false);
    CHECK_STRING(report_text(report),
                 "{\"technique\": \"a \\\"b\\\"\\u000a\\\\\", \"seconds\": 1.5, \"none\": null, "
                 "\"stages\": [{\"i\": 0}, {\"i\": 1}], \"empty\": [], \"cached\": false}");
    report_destroy(report);
}

TEST(report_with_an_open_or_unopened_object_has_no_text)
{
    struct report *report = report_create(test_host());
    report_begin_object(report, "open");
    report_begin_object(report, "inner");
    CHECK(!report_text(report));
    report_destroy(report);
    report = report_create(test_host());
    report_end(report);
    report_end(report);
    CHECK(!report_text(report));
    report_destroy(report);
}

TEST(report_has_a_decimal_point_in_every_locale)
{
    test_use_decimal_comma(); // may skip the test: before anything to free
    struct report *report = report_create(test_host());
    report_number(report, "seconds", 1.5);
    setlocale(LC_ALL, "C");
    CHECK_STRING(report_text(report), "{\"seconds\": 1.5}");
    report_destroy(report);
}

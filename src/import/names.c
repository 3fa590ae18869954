#include "import/import.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

const char *name_of_set(int number)
{
    static const struct {
        int number;
        const char *name;
    } sets[] = {
        {15, "nodes"},
        {18, "coordinate systems"},
        {55, "data at nodes"},
        {58, "function at a degree of freedom"},
        {82, "trace line"},
        {151, "header"},
        {164, "units"},
        {781, "nodes, double precision"},
        {2411, "nodes, double precision"},
        {2412, "elements"},
        {2414, "analysis data"},
        {2420, "coordinate systems"},
    };
    for (int i = 0; i < COUNT(sets); ++i)
        if (sets[i].number == number)
            return sets[i].name;
    return NULL;
}

const char *name_of_function(int type, int plural)
{
    static const char *const names[][2] = {
        {"general function", "general functions"},
        {"time record", "time records"},
        {"auto spectrum", "auto spectra"},
        {"cross spectrum", "cross spectra"},
        {"transfer function", "transfer functions"},
        {"transmissibility", "transmissibilities"},
        {"coherence", "coherences"},
        {"auto correlation", "auto correlations"},
        {"cross correlation", "cross correlations"},
        {"power spectral density", "power spectral densities"},
        {"energy spectral density", "energy spectral densities"},
        {"probability density", "probability densities"},
        {"spectrum", "spectra"},
    };
    static const char *const other[] = {"function of another type", "functions of another type"};
    return type >= 0 && type < COUNT(names) ? names[type][plural != 0] : other[plural != 0];
}

const char *name_of_analysis(int type)
{
    static const char *const names[] = {"unknown",     "static",
                                        "normal mode", "complex mode, first order",
                                        "transient",   "frequency response",
                                        "buckling",    "complex mode, second order"};
    return type >= 0 && type < COUNT(names) ? names[type] : "other";
}

const char *name_of_units(int code)
{
    static const char *const names[] = {"none",
                                        "SI (m, N)",
                                        "foot, pound force",
                                        "m, kilogram force",
                                        "foot, poundal",
                                        "mm, milli newton",
                                        "cm, centi newton",
                                        "inch, pound force",
                                        "mm, kilogram force",
                                        "user defined"};
    return code >= 0 && code < COUNT(names) ? names[code] : "unknown";
}

const char *place_text(int node, int direction, char buffer[PLACE_MOST])
{
    static const char *const axes[] = {"", "X", "Y", "Z", "RX", "RY", "RZ"};
    if (direction && abs(direction) < COUNT(axes))
        (void)snprintf(buffer, PLACE_MOST, "%d:%c%s", node, direction < 0 ? '-' : '+', axes[abs(direction)]);
    else
        (void)snprintf(buffer, PLACE_MOST, "%d", node);
    return buffer;
}

const char *si_unit(int specific_type)
{
    static const char *const units[] = {[2] = "Pa", [8] = "m",   [9] = "N",   [11] = "m/s", [12] = "m/s2",
                                        [13] = "N", [15] = "Pa", [16] = "kg", [17] = "s",   [18] = "Hz"};
    return specific_type >= 0 && specific_type < COUNT(units) && units[specific_type] ? units[specific_type] : "";
}

double unit_text_factor(int specific_type, const char *text)
{
    static const struct {
        int type;
        const char *text;
        double factor;
    } units[] = {
        {8, "m", 1},          {8, "mm", 1e-3},       {8, "um", 1e-6},
        {8, "in", 0.0254},    {11, "m/s", 1},        {11, "mm/s", 1e-3},
        {11, "in/s", 0.0254}, {12, "m/s2", 1},       {12, "m/s^2", 1},
        {12, "m/s**2", 1},    {12, "m/s/s", 1},      {12, "mm/s2", 1e-3},
        {12, "mm/s^2", 1e-3}, {12, "in/s2", 0.0254}, {12, "in/s^2", 0.0254},
        {12, "g", 9.80665},   {12, "gn", 9.80665},   {13, "N", 1},
        {13, "kN", 1e3},      {13, "mN", 1e-3},      {13, "lbf", 4.4482216152605},
        {15, "Pa", 1},        {15, "kPa", 1e3},      {15, "MPa", 1e6},
        {17, "s", 1},         {17, "sec", 1},        {17, "ms", 1e-3},
        {18, "Hz", 1},        {18, "kHz", 1e3},      {18, "rad/s", 0.15915494309189535},
        {18, "rpm", 1 / 60.}, {12, "G", 9.80665},
    };
    int type = specific_type == 9 ? 13 : specific_type, is_motion = type == 8 || type == 11 || type == 12;
    size_t length = strlen(text);
    if (is_motion && length > 2 && !strcmp(text + length - 2, "/N")) /* the whole quotient where the motion belongs */
        length -= 2;
    for (int i = 0; i < COUNT(units); ++i)
        if (units[i].type == type && strlen(units[i].text) == length && !strncmp(units[i].text, text, length)) /* mN is not MN */
            return units[i].factor;
    return 0;
}

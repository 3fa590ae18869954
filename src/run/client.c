#include "run/client.h"

static int matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct client *client = user;
    beam_assemble(&client->beam, x, stiffness, mass);
    return 0;
}

/* rotid_model gives x here too; the beam already stands at it, since derivatives follow matrices at the same point */
static int derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct client *client = user;
    for (int q = 0; q < client->beam.nparameter; q++)
        *parameter_value(&client->beam.rotor, client->beam.parameter[q]) = x[q];
    beam_differentiate(&client->beam, p, stiffness, mass);
    return 0;
}

static int choose_masters(struct pool *pool, struct client *client)
{
    const struct mesh *mesh = &client->beam.mesh;
    int nsensor = client->beam.rotor.nsensor, count = 0;
    client->master = POOL_ARRAY(pool, int, nsensor ? nsensor : mesh->naxis);
    if (!client->master)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < nsensor; i++)
        client->master[count++] = 2 * mesh->sensor_node[i];
    for (int i = 0; !nsensor && i < mesh->naxis; i++)
        client->master[count++] = 2 * i;
    client->model.nmaster = count;
    client->model.master = client->master;
    for (int i = 1; i < count; i++) /* two sensors that fall on one node */
        if (client->master[i] <= client->master[i - 1])
            return ROTID_ERROR_ARGUMENT;
    return ROTID_OK;
}

int client_open(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
                struct client *client, int *failed)
{
    int status = beam_build(pool, rotor, nparameter, parameter, refine, &client->beam, failed);
    if (status)
        return status;
    const struct mesh *mesh = &client->beam.mesh;
    client->model = (rotid_model){.size = sizeof client->model,
                                  .n = mesh->ndof,
                                  .kd = mesh->kd,
                                  .nfar = mesh->nfar,
                                  .far = mesh->far,
                                  .nparam = nparameter,
                                  .matrices = matrices,
                                  .derivatives = derivatives,
                                  .user = client};
    status = choose_masters(pool, client);
    double *x = POOL_ARRAY(pool, double, nparameter);
    if (status || !x)
        return status ? status : ROTID_ERROR_MEMORY;
    for (int p = 0; p < nparameter; p++)
        x[p] = *parameter_value(&client->beam.rotor, parameter[p]);
    return beam_count_rigid(pool, &client->beam, x, &client->model.nrigid);
}
